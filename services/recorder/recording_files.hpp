#pragma once
/// The files of one recording: one file, or parts of limited size or duration. Each file is self-contained.
/// With a quota, the oldest parts of this recording are deleted, and no other file.
#include <sys/stat.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "crane/recording/loss.hpp"
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

/// Without any limit the recording is one file.
struct Limits {
  std::uint64_t part_bytes = 0;      ///< largest size of a part, bytes; 0: no limit
  std::chrono::nanoseconds part{0};  ///< duration of a part in log time; 0: no limit
  /// Largest sum of the sizes of all parts, bytes; 0: no limit. Needs part_bytes, at most half of the quota.
  std::uint64_t quota_bytes = 0;

  [[nodiscard]] bool split() const { return part_bytes > 0 || part.count() > 0; }
};

/// Smallest permitted part_bytes. Types, rig file and index of an empty file have about 0.4 MB.
inline constexpr std::uint64_t kSmallestPart_bytes = 1'000'000;

class RecordingFiles {
 public:
  /// Writes types, topics, metadata and attachments to a new file, and returns the topics by channel.
  using Prepare = std::function<std::vector<std::string>(recording::McapWriter&)>;
  /// Creates the first file. @throws recording::WriteError
  RecordingFiles(std::filesystem::path recording, Limits limits, Prepare prepare);

  /// Writes an entry, to a new part when the entry exceeds a limit of the present one.
  /// @throws recording::WriteError
  void write(const Entry& entry);
  void write(recording::Loss loss);
  /// Writes everything to the disk. When the present file was deleted, the recording continues in a new file,
  /// and the samples of the deleted file are a loss. @throws recording::WriteError
  void flush();
  void close();

  [[nodiscard]] std::uint64_t bytes() const;  ///< of the existing files
  [[nodiscard]] std::uint32_t parts() const { return number_; }
  /// Warnings since the last call: a deleted file, a part that cannot be deleted.
  [[nodiscard]] std::vector<std::string> take_warnings();
  [[nodiscard]] const std::string& topic(std::uint16_t channel) const { return topics_.at(channel); }

 private:
  /// Samples of a topic in the present file.
  struct Content {
    std::uint64_t samples = 0;
    std::int64_t first_ns = 0, last_ns = 0;
  };
  /// A closed part. A file that replaces it differs in inode, size or time of the last change.
  struct Closed {
    std::filesystem::path file;
    std::uint64_t bytes = 0;
    struct stat status {};
  };

  [[nodiscard]] bool exceeds_limit(const Entry& entry) const;
  void begin_file();
  void begin_part(std::int64_t log_time_ns);
  void close_part();
  void keep_quota();
  void replace_removed_file();

  std::filesystem::path recording_, file_;
  Limits limits_;
  Prepare prepare_;
  std::optional<recording::McapWriter> writer_;
  std::uint32_t number_ = 0;  // of the present part
  std::uint16_t loss_channel_ = 0;
  std::vector<std::string> topics_;      // by channel
  std::vector<Content> contents_;        // by channel
  std::vector<recording::Loss> losses_;  // in the present file
  std::optional<std::int64_t> part_ends_ns_;
  std::deque<Closed> closed_;
  std::uint64_t closed_bytes_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace crane::recorder
