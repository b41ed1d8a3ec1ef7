#include "toml_document.hpp"

#include <algorithm>

#include "crane/fields/shortest.hpp"
#include "key_hint.hpp"
#include "section_reader.hpp"

namespace crane::configuration {
std::string written(const toml::node& node) {
  if (const auto* value = node.as_floating_point()) return fields::shortest(value->get());
  if (const auto* value = node.as_integer()) return std::to_string(value->get());
  if (const auto* value = node.as_boolean()) return value->get() ? "true" : "false";
  if (const auto* value = node.as_string()) {
    constexpr std::size_t kShown = 60;
    const auto& text = value->get();
    return text.size() <= kShown ? '"' + text + '"' : '"' + text.substr(0, kShown) + "...\"";
  }
  if (node.is_table()) return "(table)";
  return node.is_array() ? "(array)" : "(date or time)";
}

int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

std::string TomlTable::Place::name_of(std::string_view key) const {
  return path.empty() ? std::string(key) : path + '.' + std::string(key);
}

TomlTable::Place* TomlTable::Document::place(const std::string& path, const toml::node* node,
                                             const Place& parent) {
  const auto [entry, is_new] = places.try_emplace(path);
  Place& opened = entry->second;
  if (!is_new) return &opened;
  opened.path = path;
  opened.table = node == nullptr ? nullptr : node->as_table();
  opened.line = parent.line;
  opened.file = parent.file;
  if (opened.table != nullptr && opened.table->source().path != nullptr) {
    opened.line = line_of(*opened.table);
    opened.file = *opened.table->source().path;
  }
  return &opened;
}

void TomlTable::Document::report(const toml::node* node, const Place& place, const std::string& text) {
  const bool located = node != nullptr && node->source().path != nullptr && line_of(*node) > 0;
  problems.push_back(
      {located ? *node->source().path : place.file, located ? line_of(*node) : place.line, text});
}

void TomlTable::Document::report_unknown_and_missing(Place& place) {
  if (place.table == nullptr) return;
  // More than the keys of a table: the search for similar names in a huge file must not take seconds.
  constexpr int kMostHints = 100;
  int hints = 0;
  std::set<std::string> meant;
  for (const auto& [key, node] : *place.table) {
    if (place.known.contains(key.str())) continue;
    const KeyHint hint = ++hints <= kMostHints ? key_hint(key.str(), place.known) : KeyHint{};
    meant.insert(hint.meant);
    report(&node, place, place.name_of(key.str()) + " = " + written(node) + ": " + hint.rule);
  }
  for (const auto& key : place.missing) {
    // A misspelt key was reported above as unknown. The same key is not also reported as missing.
    if (!meant.contains(key)) report(nullptr, place, place.name_of(key) + ": missing");
  }
  place.missing.clear();
}

std::vector<std::string> TomlTable::Document::sorted_problems() {
  const auto rank = [this](const Problem& problem) {
    return std::find(files.begin(), files.end(), problem.file) - files.begin();
  };
  std::stable_sort(problems.begin(), problems.end(), [&](const Problem& a, const Problem& b) {
    return std::pair(rank(a), a.line) < std::pair(rank(b), b.line);
  });
  std::vector<std::string> lines;
  for (const auto& [file, line, text] : problems) {
    lines.push_back(file + ':' + std::to_string(line) + ": " + text);
  }
  return lines;
}

}  // namespace crane::configuration
