#pragma once
/// Copies a time range of a recording to a new recording, or merges several recordings into one. The new
/// recording contains the messages without change, and the channels, metadata and attachments. The new file
/// appears, or replaces an existing file, only when it is complete.
#include <filesystem>
#include <span>
#include <stdexcept>

#include "crane/recording/mcap_reader.hpp"

namespace crane::recording {

/// The recordings cannot be merged, or the time range contains no message. what() has one line for each
/// problem.
class EditError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Range of log time of `crane log cut`, s since the first message of the recording
/// (docs/data.md#recordings).
struct TimeRange {
  double from_s = 0;
  double until_s = std::numeric_limits<double>::infinity();
};

/// Selection of the messages of all topics within the range.
[[nodiscard]] Selection selection_of(const McapReader& recording, const TimeRange& range);

/// Copies the messages within the range and adds the metadata record "cut" with the range. @return number of
/// copied messages, and the damage of `file`
/// @throws ReadError, WriteError; EditError when no message is within the range
CheckReport cut(const std::filesystem::path& file, const TimeRange& range, const std::filesystem::path& out);

/// Merges recordings (`crane log merge`, docs/data.md#recordings). Adds the metadata record "merge"
/// with the names of the files.
/// @return number of copied messages, and the damage of all files
/// @throws ReadError, WriteError; EditError when one recording is named twice, or two recordings have
///   different schemas of one type, different types of one topic, different attachments of one name, or
///   different TOML attachments (rig files)
CheckReport merge(std::span<const std::filesystem::path> files, const std::filesystem::path& out);

}  // namespace crane::recording
