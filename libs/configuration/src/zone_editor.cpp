#include "crane/configuration/zone_editor.hpp"

#include <algorithm>
#include <regex>

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

/// First line of the n-th table [[zone]], and the line after its last key.
struct Block {
  std::size_t begin = 0, end = 0;
};
Block block_of(const std::vector<std::string>& lines, std::size_t n) {
  static const std::regex zone{R"(\s*\[\[\s*zone\s*\]\].*\s*)"}, header{R"(\s*\[.*\s*)"},
      empty{R"(\s*(#.*)?\s*)"};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!std::regex_match(lines[i], zone) || n-- > 0) continue;
    Block block{i, i + 1};
    for (std::size_t k = i + 1; k < lines.size() && !std::regex_match(lines[k], header); ++k)
      if (!std::regex_match(lines[k], empty)) block.end = k + 1;
    return block;
  }
  return {};
}

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw ConfigurationError{{file + ": " + why + ": edit the file by hand"}};
}

/// @return `text`, if it describes the rig `wanted`
std::string checked(std::string text, const std::string& file, const Rig& wanted) {
  if (!(parse_rig(text, file) == wanted))
    refuse(file,
           "the zones of this file are not tables [[zone]] of its own (an inline array, or zones of a base "
           "file)");
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

}  // namespace crane::configuration
