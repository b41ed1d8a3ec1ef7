#pragma once
/// The operator token, in a file that only its owner can read, so that neither a command line nor a URL shows
/// it.
#include <filesystem>
#include <string>

namespace crane::dashboard {

inline constexpr std::size_t kShortestToken = 16, kLongestToken = 1024;  // characters

/// Reads the token; creates the file with a random token when it does not exist.
/// @throws configuration::ConfigurationError when the file is a link or no regular file, when it belongs to
/// another user, when other users can read or change it, or when the token is too short or too long
[[nodiscard]] std::string read_or_make_token(const std::filesystem::path& file);

}  // namespace crane::dashboard
