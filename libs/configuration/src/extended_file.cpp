#include "crane/configuration/extended_file.hpp"

#include <algorithm>
#include <fstream>

#include "crane/configuration/rig.hpp"
#include "crane/fields/printable.hpp"
#include "toml_limits.hpp"

namespace crane::configuration {
namespace {

/// Reports only the missing base, because all other checks depend on it.
[[noreturn]] void refuse(const TomlTable& document, const std::string& extended, const std::string& rule) {
  constexpr std::size_t kShown = 60;
  throw ConfigurationError(
      {document.place("extends") + "extends = \"" + fields::printable(extended, kShown) + "\": " + rule});
}

/// @param chain  files that extend `file`; afterwards also `file` and its bases
TomlTable with_base_outside(const std::string& text, const std::filesystem::path& file,
                            std::vector<std::filesystem::path>& chain) {
  TomlTable document(text, file.string());
  const std::string extended = document.text("extends", "");
  chain.push_back(file.lexically_normal());
  if (extended.empty()) return document;
  const auto base = (file.parent_path() / extended).lexically_normal();
  if (std::find(chain.begin(), chain.end(), base) != chain.end())
    refuse(document, extended, "must not lead back to this file");
  std::error_code unusable;  // also of a name that no file can have
  if (!std::filesystem::is_regular_file(base, unusable))
    refuse(document, extended, "must name a file, relative to this one");
  document.inherit(with_base_outside(file_text(base), base, chain));
  return document;
}

}  // namespace

std::string file_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) {
    throw ConfigurationError({file.string() + ":1: file: cannot be read"});
  }
  // Reads one byte more than permitted, so that the reader of TOML refuses a longer text. The limit also
  // bounds the reading of an endless device.
  std::string text(kLongestToml_bytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

TomlTable with_base(const std::string& text, const std::filesystem::path& file) {
  std::vector<std::filesystem::path> chain;
  return with_base_outside(text, file, chain);
}

std::vector<std::filesystem::path> with_base_files(const std::vector<std::filesystem::path>& files) {
  std::vector<std::filesystem::path> all;
  for (const auto& file : files) {
    std::vector<std::filesystem::path> chain;
    (void)with_base_outside(file_text(file), file, chain);
    all.insert(all.end(), chain.begin(), chain.end());
  }
  return all;
}

}  // namespace crane::configuration
