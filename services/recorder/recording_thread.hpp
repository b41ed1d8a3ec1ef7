#pragma once
/// Writes a recording in a separate thread with a bounded queue, so that a slow disk does not delay the
/// caller. Samples that do not fit into the queue are dropped and counted.
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "crane/recording/mcap_writer.hpp"

namespace crane::recorder {

/// One message for the file.
struct Entry {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::int64_t log_time_ns = 0, publish_time_ns = 0;
  std::vector<std::uint8_t> data;
  bool urgent = false;  ///< true: write to the file at once, for example at a fault
};

class RecordingThread {
 public:
  /// @param capacity  maximum number of waiting entries, > 0; the writer may hold the same number in addition
  RecordingThread(recording::McapWriter writer, std::size_t capacity);
  ~RecordingThread() { close(); }
  RecordingThread(const RecordingThread&) = delete;
  RecordingThread& operator=(const RecordingThread&) = delete;

  /// Does not block on the disk. @return false when the entry is dropped: the queue is full, or writing has
  /// failed
  bool put(Entry entry);
  /// Writes all waiting entries and closes the file. Further calls have no effect.
  void close();

  [[nodiscard]] std::uint64_t written() const { return written_; }  ///< entries passed to the writer
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }  ///< size of the file
  /// Reason of a write failure; nothing without a failure.
  [[nodiscard]] std::optional<std::string> failure() const;

 private:
  void run();
  void write_until_closed();

  recording::McapWriter writer_;
  std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<Entry> waiting_;
  std::optional<std::string> failure_;
  bool closing_ = false;
  std::atomic<std::uint64_t> written_{0}, dropped_{0}, bytes_{0};
  std::thread thread_;  // last member: starts after all other members are constructed
};

}  // namespace crane::recorder
