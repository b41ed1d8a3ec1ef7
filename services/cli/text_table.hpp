#pragma once
/// Text table with aligned columns, for a terminal.
#include <iosfwd>
#include <string>
#include <vector>

namespace crane::cli {

class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header) { add(std::move(header)); }
  /// Adds a row; missing cells are empty.
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  /// Prints the table. Cells that begin with a digit or minus sign are aligned right, except "-". Lines have
  /// no trailing blanks.
  void print(std::ostream& out) const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// `value` with `digits` decimals: "0.25".
[[nodiscard]] std::string fixed(double value, int digits);

}  // namespace crane::cli
