#pragma once
/// The files of a recording that is split into parts: the name run.mcap stands for run_000001.mcap,
/// run_000002.mcap, ...
#include <cstdint>
#include <filesystem>
#include <vector>

namespace crane::recording {

struct Part {
  std::uint32_t number = 0;
  std::filesystem::path file;
};

/// File of part `number` (1, 2, ...) of `recording`; the names sort like the numbers up to 999999.
[[nodiscard]] std::filesystem::path part_file(const std::filesystem::path& recording, std::uint32_t number);

/// Existing parts of `recording` in the order of their numbers.
[[nodiscard]] std::vector<Part> parts_of(const std::filesystem::path& recording);

/// The files that the name of a recording stands for: the file of this name, otherwise its parts.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const std::filesystem::path& recording);

}  // namespace crane::recording
