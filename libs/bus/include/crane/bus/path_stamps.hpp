#pragma once
/// Clock stamps along the path of the samples through one process, for `crane bench tick`: a memory file that
/// another process reads at the same time. A process without stamps reads no additional clock.
#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "crane/topics.hpp"

namespace crane::bus {

/// Path of one published loop sample. Times of CLOCK_MONOTONIC [ns]; 0: this process has no such step.
struct PathRecord {
  std::uint64_t topic = 0;  ///< of the published sample: index in topics::kAll
  std::uint64_t tick = 0;   ///< Header.tick of the published sample
  std::int64_t sample_time_ns = 0;
  /// By topic: the thread of the vendor has delivered the newest sample to its reader.
  std::array<std::int64_t, topics::kAll.size()> arrived_ns{};
  std::int64_t polled_ns = 0;     ///< the loop began the poll that published the sample
  std::int64_t taking_ns = 0;     ///< duration: take() of the vendor, all samples of the poll
  std::int64_t checking_ns = 0;   ///< duration: CRC checks, all samples of the poll
  std::int64_t joined_ns = 0;     ///< the inputs of the tick, or of the board, were complete
  std::int64_t published_ns = 0;  ///< publish() was called
  std::int64_t sealed_ns = 0;     ///< the sample had its CRC
  std::int64_t written_ns = 0;    ///< write() of the vendor has returned
};

/// @return index of the topic in topics::kAll
[[nodiscard]] std::size_t index_of(std::string_view topic);

/// Writes the records of one process. Any thread may call arrived(); the thread of the bus calls the others.
class PathStamps {
 public:
  /// @param file  of a PathStampReader. @throws Error
  explicit PathStamps(const std::string& file);
  ~PathStamps();
  PathStamps(const PathStamps&) = delete;
  PathStamps& operator=(const PathStamps&) = delete;

  [[nodiscard]] static std::int64_t now_ns();
  /// Call when the vendor has delivered a sample.
  void arrived(std::string_view topic);
  void polled(std::int64_t time_ns);
  void took(std::int64_t begin_ns, std::int64_t taken_ns, std::int64_t checked_ns);
  /// The first call of a poll counts.
  void joined();
  void published(const topics::Description& topic, const msg::Header& header, std::int64_t begin_ns,
                 std::int64_t sealed_ns);

 private:
  std::array<std::atomic<std::int64_t>, topics::kAll.size()> arrived_ns_{};
  PathRecord next_;
  struct StampFile* file_;
};

/// Environment variable with the file of a process that writes stamps.
inline constexpr const char* kStampsVariable = "CRANE_CLOCK_STAMPS";
/// Begins to write stamps when kStampsVariable names a file. Call before the first Bus. @throws Error
void stamp_paths_if_asked();
/// The stamps of this process; null: none.
[[nodiscard]] PathStamps* path_stamps();

/// Creates the memory file of one process, and reads its records. The kernel frees the file when its users
/// have ended.
class PathStampReader {
 public:
  PathStampReader();  ///< @throws Error
  ~PathStampReader();
  PathStampReader(const PathStampReader&) = delete;
  PathStampReader& operator=(const PathStampReader&) = delete;

  /// Path of the file, for other processes while this object exists.
  [[nodiscard]] std::string file() const;
  /// Appends the records since the last call. @throws Error when more than half of the ring is unread: the
  /// calls were too rare, and the writer could overwrite records while they are read
  void take(std::vector<PathRecord>& records);

 private:
  int descriptor_ = -1;
  struct StampFile* file_ = nullptr;
  std::uint64_t taken_ = 0;
};

}  // namespace crane::bus
