#pragma once
/// Files that a command writes must not be files that it reads.
#include <filesystem>
#include <vector>

namespace crane::configuration {

/// Call before anything is written or moved.
/// @throws ConfigurationError when one of `outputs` is one of `inputs`, also under another name
void require_other(const std::vector<std::filesystem::path>& outputs,
                   const std::vector<std::filesystem::path>& inputs);

}  // namespace crane::configuration
