#pragma once
/// Declarative reader of TOML input files. A getter states key and rule of a value. The reader collects all
/// problems, and finish() reports them together, sorted by line:
///
///   TomlTable root(text, "tower.toml");
///   auto drive = root.required_table("trolley");
///   const double limit_v = drive.number("volt_limit_v", Range::above(0, 10), 10.0);
///   root.finish();  // throws "tower.toml:12: trolley.volt_limit_v = 12: must be in (0, 10]"
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "crane/fields/range.hpp"

namespace crane::configuration {

using fields::Range;

/// One table of a TOML document: a cheap handle; copies refer to the same table. A table that the file does
/// not have is absent: its getters return their defaults and report no missing keys.
///
/// Every getter marks its key as known. A key with a default is optional; any other key is required. When a
/// value breaks its rule, the getter notes a problem and returns NaN (number), the default or INT_MIN
/// (integer), or an empty text. Comparisons with NaN are false, so that a check between two values, such as
/// `if (low >= high)`, adds no second problem. finish() throws before the value is used.
class TomlTable {
 public:
  /// Root table. `file` is used in messages only. @throws ConfigurationError (rig.hpp) on a syntax error
  TomlTable(const std::string& text, const std::string& file);

  /// Takes keys that this file does not have from `base`, table by table; an array is taken as a whole.
  /// Problems name the file and line of the value. @pre this is a root table without an open sub-table
  void inherit(TomlTable base);

  [[nodiscard]] bool present() const;
  /// True when the table has the key. Marks the key as known.
  [[nodiscard]] bool has(std::string_view key);
  /// Keys of this table in alphabetical order, for tables whose keys are data. Marks no key as known.
  [[nodiscard]] std::vector<std::string> keys() const;

  /// Finite number within the range; integers are accepted.
  [[nodiscard]] double number(std::string_view key, const Range& range);
  [[nodiscard]] double number(std::string_view key, const Range& range, double fallback);
  /// Integer with low <= value <= high.
  [[nodiscard]] int integer(std::string_view key, int low, int high);
  [[nodiscard]] int integer(std::string_view key, int low, int high, int fallback);
  [[nodiscard]] bool boolean(std::string_view key, bool fallback);
  [[nodiscard]] std::string text(std::string_view key);
  [[nodiscard]] std::string text(std::string_view key, std::string_view fallback);
  /// A text that is one of `choices`.
  [[nodiscard]] std::string choice(std::string_view key, const std::vector<std::string>& choices);
  [[nodiscard]] std::string choice(std::string_view key, const std::vector<std::string>& choices,
                                   std::string_view fallback);
  /// Array of numbers, each finite and within the range; empty when the key is absent.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, const Range& range);
  /// Array of texts; empty when the key is absent.
  [[nodiscard]] std::vector<std::string> texts(std::string_view key);

  /// Sub-table, absent when the file does not have it.
  [[nodiscard]] TomlTable table(std::string_view key);
  /// Sub-table whose absence is a problem.
  [[nodiscard]] TomlTable required_table(std::string_view key);
  /// [[key]]: array of tables, empty when the key is absent.
  [[nodiscard]] std::vector<TomlTable> tables(std::string_view key);

  /// Accepts all keys of this table: finish() reports none of them as unknown.
  void ignore_unknown();

  /// Adds a problem of the value of `key`: "file:line: name = value: rule". Without such a key the problem
  /// has the line of the table and no value.
  void problem(std::string_view key, const std::string& rule);
  /// Adds a problem of the table as a whole: "file:line: name: rule".
  void problem(const std::string& rule);
  /// "file:line: " of the key, or of the table if the key is absent.
  [[nodiscard]] std::string place(std::string_view key) const;

  /// Adds unknown and missing keys to the problems of the whole document.
  /// @throws ConfigurationError when there are any problems
  void finish();

 private:
  struct Place;
  struct Document;
  struct Value;
  TomlTable(std::shared_ptr<Document> document, Place* place);
  Value find(std::string_view key, bool required);
  double checked_number(const Value& value, std::string_view key, const Range& range);
  int checked_integer(const Value& value, std::string_view key, int low, int high, int fallback);
  std::string checked_text(const Value& value, std::string_view key);
  TomlTable open(std::string_view key, bool required);

  std::shared_ptr<Document> document_;
  Place* place_;
};

}  // namespace crane::configuration
