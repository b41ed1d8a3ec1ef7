#include "crane/configuration/zone_editor.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>

#include "crane/configuration/toml_reader.hpp"

namespace crane::configuration {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = text.find('\n', begin);
    const auto next = end == std::string::npos ? text.size() : end + 1;
    lines.push_back(text.substr(begin, next - begin));
    begin = next;
  }
  return lines;
}

std::string_view without_blanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  return text;
}

/// Removes `word` from the begin of `text`. @return false when the text begins with something else
bool take(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

bool is_header(std::string_view line) { return without_blanks(line).starts_with('['); }

bool is_zone_header(std::string_view line) {
  std::string_view rest = without_blanks(line);
  if (!take(rest, "[[")) return false;
  rest = without_blanks(rest);
  if (!take(rest, "zone")) return false;
  return without_blanks(rest).starts_with("]]");
}

bool is_empty_or_comment(std::string_view line) {
  const auto rest = without_blanks(line);
  return rest.empty() || rest.starts_with('#');
}

/// First line of the n-th table [[zone]], and the line after its last key.
struct Block {
  std::size_t begin = 0, end = 0;
};
Block block_of(const std::vector<std::string>& lines, std::size_t n) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!is_zone_header(lines[i]) || n-- > 0) continue;
    Block block{i, i + 1};
    for (std::size_t k = i + 1; k < lines.size() && !is_header(lines[k]); ++k)
      if (!is_empty_or_comment(lines[k])) block.end = k + 1;
    return block;
  }
  return {};
}

/// Place of the quoted value of the key `extends`, with its quotes, in a text without a header before it.
struct Quoted {
  std::size_t begin = 0, length = 0;
};
std::optional<Quoted> value_of_extends(const std::string& text) {
  std::size_t begin = 0;
  for (const auto& line : lines_of(text)) {
    std::string_view rest = without_blanks(line);
    if (is_header(line)) return std::nullopt;
    begin += line.size();
    if (!take(rest, "extends")) continue;
    rest = without_blanks(rest);
    if (!take(rest, "=")) continue;
    rest = without_blanks(rest);
    if (rest.empty() || (rest.front() != '"' && rest.front() != '\'')) return std::nullopt;
    const char quote = rest.front();
    for (std::size_t i = 1; i < rest.size(); ++i) {
      if (rest[i] == quote) return Quoted{begin - rest.size(), i + 1};
      if (rest[i] == '\\' && quote == '"') ++i;
    }
    return std::nullopt;
  }
  return std::nullopt;
}

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw ConfigurationError{{file + ": " + why + ": edit the file by hand"}};
}

/// @return `text`, if it describes the rig `wanted`
std::string checked(std::string text, const std::string& file, const Rig& wanted) {
  if (!(parse_rig(text, file) == wanted))
    refuse(file, "the zones of this file are an inline array or belong to a base file");
  return text;
}

}  // namespace

std::string with_zone(const std::string& text, const std::string& file, const control::Zone& zone) {
  Rig wanted = parse_rig(text, file);
  if (std::ranges::find(wanted.zones, zone.name, &control::Zone::name) != wanted.zones.end())
    throw ConfigurationError{
        {file + ": there is a zone " + zone.name + " already: remove it first, or give another name"}};
  wanted.zones.push_back(zone);
  return checked(text + (text.empty() || text.back() == '\n' ? "" : "\n") + to_toml(zone), file, wanted);
}

std::string without_zone(const std::string& text, const std::string& file, const std::string& name) {
  Rig wanted = parse_rig(text, file);
  const auto found = std::ranges::find(wanted.zones, name, &control::Zone::name);
  if (found == wanted.zones.end()) throw ConfigurationError{{file + ": no zone " + name}};
  auto lines = lines_of(text);
  Block block = block_of(lines, static_cast<std::size_t>(found - wanted.zones.begin()));
  if (block.end == 0) refuse(file, "the zone is not a table [[zone]] of this file");
  // with_zone() puts an empty line before a table
  const auto is_empty = [&lines](std::size_t i) { return i >= lines.size() || lines[i] == "\n"; };
  if (block.begin > 0 && is_empty(block.begin - 1) && is_empty(block.end)) --block.begin;
  const auto at = [&lines](std::size_t i) { return lines.begin() + static_cast<std::ptrdiff_t>(i); };
  lines.erase(at(block.begin), at(block.end));
  wanted.zones.erase(found);
  std::string shorter;
  for (const auto& line : lines) shorter += line;
  return checked(std::move(shorter), file, wanted);
}

std::string moved(const std::string& text, const std::filesystem::path& from,
                  const std::filesystem::path& to) {
  Rig wanted = parse_rig(text, from.string());
  wanted.path = to.string();
  const std::string extended = TomlTable(text, from.string()).text("extends", "");
  const auto directory_of = [](const std::filesystem::path& file) {
    return std::filesystem::absolute(file).lexically_normal().parent_path();
  };
  std::string changed = text;
  if (!extended.empty() && std::filesystem::path{extended}.is_relative() &&
      directory_of(from) != directory_of(to))
    if (const auto value = value_of_extends(text))
      changed.replace(value->begin, value->length,
                      toml_string((directory_of(from) / extended).lexically_normal().string()));
  std::optional<Rig> read;
  try {
    read = parse_rig(changed, to.string());
  } catch (const ConfigurationError&) {  // the base file is missing at the new place
  }
  if (read != wanted)
    throw ConfigurationError{{to.string() + ": extends = \"" + extended + "\" of " + from.string() +
                              " names another file from this directory: write the file beside " +
                              from.string() + ", or edit `extends` by hand"}};
  return changed;
}

}  // namespace crane::configuration
