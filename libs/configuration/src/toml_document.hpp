#pragma once
/// Data that all handles of one TOML document share: parsed tables, requested keys, problems.
#include <toml++/toml.h>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "crane/configuration/toml_reader.hpp"

namespace crane::configuration {

/// A table that was opened. The file need not contain it.
struct TomlTable::Place {
  const toml::table* table = nullptr;  ///< nullptr: absent
  std::string path;                    ///< "drive.trolley", "model.terms[2]", empty for the root
  int line = 1;                        ///< line of its problems
  std::string file;
  std::set<std::string, std::less<>> known;
  std::vector<std::string> missing;

  [[nodiscard]] std::string name_of(std::string_view key) const;
};

/// A value that was requested.
struct TomlTable::Value {
  const toml::node* node = nullptr;  ///< nullptr: absent
  Place* place = nullptr;
  std::string name;
};

struct TomlTable::Document {
  struct Problem {
    std::string file;
    int line;
    std::string text;
  };

  toml::table root;
  std::vector<std::string> files;       ///< in the order in which their problems are reported
  std::map<std::string, Place> places;  ///< by path
  std::vector<Problem> problems;

  Place* place(const std::string& path, const toml::node* node, const Place& parent);
  void report(const toml::node* node, const Place& place, const std::string& text);
  void report_unknown_and_missing(Place& place);
  /// "file:line: text", sorted by file and line.
  [[nodiscard]] std::vector<std::string> sorted_problems();
};

/// The value as TOML, shortened; a table is "(table)".
[[nodiscard]] std::string written(const toml::node& node);
[[nodiscard]] int line_of(const toml::node& node);

}  // namespace crane::configuration
