#pragma once
/// Writes a recording in a separate thread with a bounded queue, so that a slow disk does not delay the
/// caller. Samples that do not fit into the queue are dropped and counted. The recording contains how many
/// samples of each topic are missing, when and why (crane/recording/loss.hpp).
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "recorder/recording_files.hpp"

namespace crane::recorder {

class RecordingThread {
 public:
  /// @param capacity  maximum number of waiting entries, > 0; the writer may hold the same number in addition
  RecordingThread(RecordingFiles files, std::size_t capacity);
  ~RecordingThread() { close(); }
  RecordingThread(const RecordingThread&) = delete;
  RecordingThread& operator=(const RecordingThread&) = delete;

  /// Does not block on the disk. @return false when the entry is dropped: the queue is full, or writing has
  /// failed
  bool put(Entry entry);
  /// Adds samples that did not arrive to the losses of the recording.
  void lose(std::uint16_t channel, recording::LossCause cause, std::uint64_t samples, std::int64_t time_ns);
  /// Writes all waiting entries and closes the file. Further calls have no effect.
  void close();

  [[nodiscard]] std::uint64_t written() const { return written_; }  ///< entries passed to the writer
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }    ///< sum of all lose()
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }  ///< size of the files
  [[nodiscard]] std::uint32_t parts() const { return parts_; }  ///< number of files so far
  /// Reason of a write failure; nothing without a failure.
  [[nodiscard]] std::optional<std::string> failure() const;
  /// Warnings of the files since the last call.
  [[nodiscard]] std::vector<std::string> take_warnings();

 private:
  /// One loss of the present second for each channel and cause.
  using Losses = std::map<std::pair<std::uint16_t, recording::LossCause>, recording::Loss>;

  void run();
  void write_until_closed();
  void write_losses();
  void show_state();
  void note_loss(std::uint16_t channel, recording::LossCause cause, std::uint64_t samples,
                 std::int64_t time_ns);

  RecordingFiles files_;
  std::vector<Entry> batch_;  // of the thread
  std::size_t done_ = 0;      // entries of the batch that are written
  std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<Entry> waiting_;
  Losses losses_;
  std::vector<std::string> warnings_;
  std::optional<std::string> failure_;
  bool closing_ = false;
  std::atomic<std::uint64_t> written_{0}, dropped_{0}, lost_{0}, bytes_{0};
  std::atomic<std::uint32_t> parts_{1};
  std::thread thread_;  // last member: starts after all other members are constructed
};

}  // namespace crane::recorder
