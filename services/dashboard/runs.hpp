#pragma once
/// Recordings that the page may open: files of one directory and its subdirectories, and uploaded files. A
/// request names a run by its entry in the list; request text never becomes a path.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace crane::dashboard {

struct Run {
  std::string name;  ///< "maneuver_1/recording.mcap", "upload:lab.csv"
  std::filesystem::path file;
  std::uintmax_t bytes = 0;
  std::int64_t changed_s = 0;  ///< s since 1970
  bool recording = false;      ///< true: MCAP; false: CSV, which can be diagnosed but not reviewed
  [[nodiscard]] bool too_large() const;
};

class Runs {
 public:
  static constexpr std::uintmax_t kLargest_bytes = 256U << 20U;  ///< largest run that is opened
  static constexpr std::size_t kMostListed = 500;      ///< largest number of listed runs, the newest
  static constexpr std::size_t kMostVisited = 20'000;  ///< largest number of examined directory entries
  static constexpr int kDeepest = 2;                   ///< levels of subdirectories
  static constexpr std::uintmax_t kMostUploads_bytes = 64U << 20U;
  static constexpr std::size_t kMostUploads = 32;

  /// @param directory  empty: none  @param uploads  existing directory; empty: uploads are refused
  Runs(std::filesystem::path directory, std::filesystem::path uploads)
      : directory_{std::move(directory)}, uploads_{std::move(uploads)} {}

  [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }
  /// Newest first. Symbolic links are not followed.
  [[nodiscard]] std::vector<Run> list() const;
  [[nodiscard]] std::optional<Run> find(std::string_view name) const;

  /// Stores an uploaded file as "upload:NAME". @return reason of a refusal; empty when stored
  [[nodiscard]] std::string keep(std::string_view name, std::string_view bytes) const;

 private:
  std::filesystem::path directory_, uploads_;
};

/// 1 to 64 letters, digits, '_', '-' and '.', not beginning with '.', ending with .csv or .mcap
[[nodiscard]] bool is_upload_name(std::string_view name);

}  // namespace crane::dashboard
