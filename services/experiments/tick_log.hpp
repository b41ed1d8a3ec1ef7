#pragma once
/// Writes all samples of each tick of a lockstep run in a fixed order to the recording and to the table of
/// the run.
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "crane/recording/mcap_writer.hpp"
#include "crane/recording/run_table.hpp"
#include "crane/runtime/tick_join.hpp"

namespace crane::experiments {

struct Tick {
  const msg::State* state = nullptr;
  const msg::Reference* reference = nullptr;
  const msg::Contribution* tracking = nullptr;
  const msg::Contribution* anti_swing = nullptr;
  const msg::Demand* demand = nullptr;
  const msg::Command* command = nullptr;
  const msg::SupervisorStatus* supervisor = nullptr;
};

/// A sample of any other loop topic, as plain CDR with its encapsulation header.
struct OtherSample {
  const topics::Description* topic;
  std::span<const std::uint8_t> cdr;
};

class TickLog {
 public:
  /// @param recording  MCAP file; nothing: table only. @throws recording::WriteError
  explicit TickLog(const std::optional<std::filesystem::path>& recording);
  /// Stores the origin of the run (metadata record "crane") and its rig file (attachment "rig.toml"), from
  /// which `crane replay` builds the stack again. @throws recording::WriteError
  void describe(const recording::Metadata& run, std::string_view rig_text);
  /// Stores a sample of an operator, which the stack receives before the next tick. The next add() writes the
  /// sample before the samples of its tick, with the time of this tick.
  template <class T>
  void receive(const topics::Topic<T>& topic, const T& sample) {
    if (writer_) inputs_.push_back({&topic.description, encoded(topic.description, &sample)});
  }
  /// @throws recording::WriteError
  void add(const Tick& tick, std::span<const OtherSample> others = {});
  void close();
  /// Rows from tick `zero_tick` on, where time_s is 0.
  [[nodiscard]] recording::Table table(std::uint64_t zero_tick) const;

 private:
  struct Input {
    const topics::Description* topic;
    std::vector<std::uint8_t> cdr;
  };
  static std::vector<std::uint8_t> encoded(const topics::Description& topic, const void* sample);
  void write(const topics::Description& topic, std::span<const std::uint8_t> cdr, std::int64_t time_ns,
             std::uint64_t tick);
  std::optional<recording::McapWriter> writer_;
  recording::TopicChannels channels_{};
  recording::RunTable rows_;
  std::vector<Input> inputs_;  ///< of the next tick
  std::int64_t period_ns_ = 0, last_time_ns_ = 0;
};

}  // namespace crane::experiments
