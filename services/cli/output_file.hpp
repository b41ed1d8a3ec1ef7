#pragma once
/// Files that commands write.
#include <filesystem>

namespace crane::cli {

/// Call before anything is written. @throws configuration::ConfigurationError when the file exists and
/// `force` is false
void require_new(const std::filesystem::path& file, bool force);

}  // namespace crane::cli
