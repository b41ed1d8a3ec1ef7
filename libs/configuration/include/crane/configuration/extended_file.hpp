#pragma once
/// Files that extend other files: `extends = "base.toml"`, relative to the extending file.
#include <filesystem>
#include <string>

#include "crane/configuration/toml_reader.hpp"

namespace crane::configuration {

/// @throws ConfigurationError when the file cannot be read
[[nodiscard]] std::string file_text(const std::filesystem::path& file);

/// Reads a document and the files that it extends. Values of the document override values of the extended
/// files.
/// @throws ConfigurationError on a syntax error or a wrong `extends`
[[nodiscard]] TomlTable with_base(const std::string& text, const std::filesystem::path& file);

}  // namespace crane::configuration
