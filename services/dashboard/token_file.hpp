#pragma once
/// The operator token, in a file that only its owner can read, so that neither a command line nor a URL shows
/// it.
#include <filesystem>
#include <string>

namespace crane::dashboard {

inline constexpr std::size_t kShortestToken = 16;

/// Reads the token; creates the file with a random token when it does not exist.
/// @throws configuration::ConfigurationError when other users can read or change the file, or the token is
/// too short
[[nodiscard]] std::string read_or_make_token(const std::filesystem::path& file);

}  // namespace crane::dashboard
