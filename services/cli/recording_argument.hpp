#pragma once
/// Command-line arguments that name recordings.
#include <CLI/CLI.hpp>
#include <filesystem>

namespace crane::cli {

/// Accepts a file, and the name of a split recording: run.mcap for run_000001.mcap, run_000002.mcap, ...
[[nodiscard]] CLI::Validator existing_recording();

/// Files that a new recording of this name would overwrite or hide: the file, and parts of this name.
[[nodiscard]] std::vector<std::filesystem::path> existing_files_of(const std::filesystem::path& recording);

}  // namespace crane::cli
