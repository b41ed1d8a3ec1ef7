#pragma once
/// Records topics of a running crane to MCAP: the received samples with a correct CRC, without change, and
/// the number and cause of the missing samples (crane/recording/loss.hpp).
///
///   log time      time of arrival: wall clock at the start of the recording plus monotonic time, so that a
///                 change of the system clock causes no jump
///   publish time  wall clock of the writer
///   sequence      tick (its lower 32 bits)
#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "crane/runtime/node.hpp"
#include "recorder/missing_samples.hpp"
#include "recorder/recording_thread.hpp"

namespace crane::recorder {

struct Options {
  std::filesystem::path file;
  std::vector<const topics::Description*> topics{};  ///< empty: all
  std::size_t queue_capacity = 16384;                ///< samples; 16384: about 20 s of a stack at 100 Hz
  Limits limits{};
  std::string rig_text{};  ///< rig file to attach; empty: none
};

class Recorder {
 public:
  /// Creates the file. @throws recording::WriteError, bus::Error
  Recorder(bus::Bus& bus, const Options& options);

  /// Passes arrived samples to the recording thread, and publishes crane/node.
  /// @return false when the file can no longer be written; crane/event reports the reason
  bool poll();
  /// Notes the remaining losses, writes the queued samples and closes the file. Samples that poll() has not
  /// taken are not recorded. @return false when writing has failed; noted losses are no failure
  bool close();

  [[nodiscard]] const RecordingThread& thread() const { return *thread_; }
  [[nodiscard]] std::uint64_t rejected() const;  ///< samples with a wrong CRC, which are not recorded
  /// True when a sample of another process has arrived.
  [[nodiscard]] bool heard_others() const { return heard_others_; }

 private:
  struct Source {
    bus::CdrSubscriber subscriber;
    std::uint16_t channel;
    bool holds_events;
    std::shared_ptr<const std::atomic<std::uint64_t>> lost;  ///< samples that DDS has reported as lost
    bool heard = false;                                      ///< a sample has arrived
    std::uint64_t lost_seen = 0, rejected_seen = 0;          ///< numbers already passed to `missing`
    MissingSamples missing;
    msg::Header last{};  ///< of the last sample
  };
  void take_all(Source& source);
  /// Counts the ticks between the last sample and this one of the same writer.
  void count_gap(Source& source, const msg::Header& header);
  /// Writes the missing samples to the recording. @param all  true: also those of the last second, although
  /// their cause may still arrive
  void note_losses(Source& source, bool all);
  void report();
  void announce_failure();
  void announce_warnings();
  [[nodiscard]] std::int64_t log_time_ns() const;

  std::filesystem::path file_;
  runtime::Node node_;
  std::vector<Source> sources_;
  std::unique_ptr<RecordingThread> thread_;
  std::int64_t wall_minus_monotonic_ns_;
  bool failure_announced_ = false, heard_others_ = false;
};

}  // namespace crane::recorder
