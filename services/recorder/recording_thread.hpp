#pragma once
/// Writes a recording on a thread of its own, behind a bounded queue: a slow disk delays nobody. What does
/// not fit into the queue is dropped and counted.
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
  bool urgent = false;  ///< to be in the file at once: something went wrong
};

class RecordingThread {
 public:
  /// @param capacity  entries that may wait, > 0; as many again may be on their way to the disk
  RecordingThread(recording::McapWriter writer, std::size_t capacity);
  ~RecordingThread() { close(); }
  RecordingThread(const RecordingThread&) = delete;
  RecordingThread& operator=(const RecordingThread&) = delete;

  /// Never blocks on the disk. @return false: dropped, the queue is full or writing has failed
  bool put(Entry entry);
  /// Writes what waits and closes the file. Calling it again does nothing.
  void close();

  [[nodiscard]] std::uint64_t written() const { return written_; }  ///< handed to the writer
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }  ///< in the file
  /// Why nothing is written any more; nothing while all is well.
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
  std::thread thread_;  // last: starts when everything else is there
};

}  // namespace crane::recorder
