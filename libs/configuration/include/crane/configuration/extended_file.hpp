#pragma once
/// Files that extend others: `extends = "base.toml"`, relative to the file that says so.
#include <filesystem>
#include <string>

#include "crane/configuration/toml_reader.hpp"

namespace crane::configuration {

/// @throws ConfigurationError when the file cannot be read
[[nodiscard]] std::string file_text(const std::filesystem::path& file);

/// Document with the values of the files it extends underneath its own. @throws ConfigurationError on a
/// syntax error or a wrong `extends`
[[nodiscard]] TomlTable with_base(const std::string& text, const std::filesystem::path& file);

}  // namespace crane::configuration
