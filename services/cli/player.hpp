#pragma once
/// Publishes the samples of a recording at their recorded intervals, for tools that read the bus. It requires
/// a bus without a crane, because a second writer of a loop topic stops a crane.
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "crane/bus/bus.hpp"
#include "crane/recording/mcap_edit.hpp"
#include "crane/recording/mcap_reader.hpp"

namespace crane::cli {

/// True for the topics that crane play may publish: all except crane/request and crane/jog, which the stack
/// accepts from any program. Readers of all other topics accept only the sources of the topic; the player has
/// a different source.
[[nodiscard]] bool may_play(const topics::Description& topic);

/// Searches for other programs that write loop topics. One participant of each vendor searches, because
/// programs of the same vendor discover each other faster than programs of different vendors.
class OtherWriters {
 public:
  explicit OtherWriters(const bus::Options& options);
  /// Declares that one writer of this topic belongs to the player.
  void except(const topics::Description& topic) { own_.insert_or_assign(topic.name, 1); }
  /// @return a loop topic with a writer of another program; nothing when there is none
  [[nodiscard]] std::optional<std::string> find() const;
  /// @throws bus::Error when a program of this crane has messages of another version
  void refuse_other_version();

 private:
  [[nodiscard]] int own(const topics::Description& topic) const;
  std::vector<bus::Bus> buses_;
  std::vector<bus::CdrSubscriber> readers_;
  std::map<std::string_view, int> own_;  ///< writers of the player by topic
};

struct PlayCounts {
  std::uint64_t played = 0;
  std::uint64_t failed = 0;  ///< samples that are damaged, or that the middleware did not send
};

class Player {
 public:
  /// Searches for other writers, creates the writers of the player, and waits until readers can have
  /// discovered these writers.
  /// @param options  of the writers; with a source that may write no topic
  /// @param topics   played topics. @throws bus::Error when another program writes a loop topic
  Player(const bus::Options& options, recording::McapReader& recording,
         const std::vector<const topics::Description*>& topics);

  /// Publishes the samples of a range of log time once.
  /// @param rate  seconds of the recording per second
  /// @return false when another writer has appeared or a stop signal has arrived
  [[nodiscard]] bool play(const recording::Selection& selection, std::int64_t begin_ns, double rate);
  /// Waits until the readers have received the last samples: a writer that ends drops
  /// unacknowledged samples.
  void finish() const;

  /// Loop topic with a foreign writer, which ended play(); nothing otherwise.
  [[nodiscard]] const std::optional<std::string>& other_writer() const { return other_writer_; }
  [[nodiscard]] const PlayCounts& counts() const { return counts_; }

 private:
  void look_for_others(std::int64_t duration_ns);
  [[nodiscard]] bool wait_for(std::int64_t due_ns);
  [[nodiscard]] bool is_alone(std::int64_t now_ns);

  bus::Bus bus_;
  recording::McapReader& recording_;
  OtherWriters others_;
  std::map<std::string_view, bus::CdrPublisher> publishers_;
  std::optional<std::string> other_writer_;
  std::int64_t looked_ns_ = 0;
  PlayCounts counts_;
};

}  // namespace crane::cli
