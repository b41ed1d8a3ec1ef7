#pragma once
/// Files that extend other files: `extends = "base.toml"`, relative to the extending file.
#include <filesystem>
#include <string>
#include <vector>

#include "crane/configuration/toml_reader.hpp"

namespace crane::configuration {

/// @throws ConfigurationError when the file cannot be read
[[nodiscard]] std::string file_text(const std::filesystem::path& file);

/// The text as a TOML string, with its quotes.
[[nodiscard]] std::string toml_string(const std::string& text);

/// Reads a document and the files that it extends. Values of the document override values of the extended
/// files.
/// @throws ConfigurationError on a syntax error or a wrong `extends`
[[nodiscard]] TomlTable with_base(const std::string& text, const std::filesystem::path& file);

/// @return the files, and all files that they extend. @throws ConfigurationError as with_base()
[[nodiscard]] std::vector<std::filesystem::path> with_base_files(
    const std::vector<std::filesystem::path>& files);

}  // namespace crane::configuration
