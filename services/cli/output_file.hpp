#pragma once
/// Files that commands write.
#include <filesystem>
#include <span>

namespace crane::cli {

/// Call before anything is written. @throws configuration::ConfigurationError when the file exists and
/// `force` is false
void require_new(const std::filesystem::path& file, bool force);

/// Call before anything is written, when a command replaces existing files.
/// @throws configuration::ConfigurationError when `file` is one of `sources`, which the command reads
void require_other(const std::filesystem::path& file, std::span<const std::filesystem::path> sources);

}  // namespace crane::cli
