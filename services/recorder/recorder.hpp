#pragma once
/// Records topics of a running crane: every sample as it came, its CRC checked, in one MCAP file.
///
/// log time      wall clock at arrival; it follows the monotonic clock from the start of the recording on, so
///               that setting the system's clock does not tear it
/// publish time  wall clock of the writer
/// sequence      tick (its lower 32 bits)
#include <filesystem>
#include <memory>
#include <vector>

#include "crane/runtime/node.hpp"
#include "recorder/recording_thread.hpp"

namespace crane::recorder {

struct Options {
  std::filesystem::path file;
  std::vector<const topics::Description*> topics{};  ///< empty: all
  std::size_t queue_capacity = 16384;                ///< samples; some 20 s of a stack at 100 Hz
};

class Recorder {
 public:
  /// Creates the file. @throws recording::WriteError, bus::Error
  Recorder(bus::Bus& bus, const Options& options);

  /// Hands over what has arrived, and reports on crane/node.
  /// @return false once the file cannot be written any more; crane/event has said why
  bool poll();
  /// Writes what waits and closes the file. @return false when the file could not be completed
  bool close();

  [[nodiscard]] const RecordingThread& thread() const { return *thread_; }
  [[nodiscard]] std::uint64_t rejected() const;  ///< samples with a wrong CRC: not recorded
  [[nodiscard]] bool heard_others() const { return heard_others_; }  ///< any sample but its own

 private:
  struct Source {
    bus::CdrSubscriber subscriber;
    std::uint16_t channel;
    bool holds_events;
  };
  void take_all(Source& source);
  void report();
  void announce_failure();
  [[nodiscard]] std::int64_t log_time_ns() const;

  std::filesystem::path file_;
  runtime::Node node_;
  std::vector<Source> sources_;
  std::unique_ptr<RecordingThread> thread_;
  std::int64_t wall_minus_monotonic_ns_;
  bool failure_announced_ = false, heard_others_ = false;
};

}  // namespace crane::recorder
