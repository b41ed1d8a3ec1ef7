#pragma once
/// A moment as a recording: samples, what the file is of, the rig file.
#include <filesystem>

#include "black_box/moments.hpp"
#include "crane/recording/mcap_writer.hpp"

namespace crane::black_box {

/// What every file of this process says.
struct Origin {
  recording::Metadata crane;       ///< "crane", "domain", "version", "host", "kernel", "cores", ...
  std::string rig_name, rig_text;  ///< attached; empty: unknown
};

/// "20261125T035501Z_SWING_LIMIT.mcap", in the order of time.
[[nodiscard]] std::string file_name_of(const Moment& moment);

/// Writes the file, which appears when it is complete. @return its path. @throws recording::WriteError
std::filesystem::path write_moment(const std::filesystem::path& directory, const Moment& moment,
                                   const Origin& origin, const recording::Metadata& processes);

/// Deletes the oldest files of a black box. Other files are left alone.
void keep_newest(const std::filesystem::path& directory, std::size_t files) noexcept;

}  // namespace crane::black_box
