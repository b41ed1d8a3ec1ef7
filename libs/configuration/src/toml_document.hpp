#pragma once
/// What the handles of one TOML document share: the parsed tables, the keys asked for, the problems found.
#include <toml++/toml.h>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "crane/configuration/toml_reader.hpp"

namespace crane::configuration {

/// One table that was opened, present in the file or not.
struct TomlTable::Place {
  const toml::table* table = nullptr;  ///< nullptr: absent
  std::string path;                    ///< "drive.trolley", "model.terms[2]", empty for the root
  int line = 1;                        ///< where its problems are reported
  std::string file;
  std::set<std::string, std::less<>> known;
  std::vector<std::string> missing;

  [[nodiscard]] std::string name_of(std::string_view key) const;
};

/// One value that was asked for.
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

/// As the file would write it, shortened; tables as "(table)".
[[nodiscard]] std::string written(const toml::node& node);
[[nodiscard]] int line_of(const toml::node& node);

}  // namespace crane::configuration
