#pragma once
/// Reads and writes measured data as CSV: separator comma, one header line, one number per cell.
/// `time_s` is the first column; any of the other canonical columns and then other columns follow.
/// The sampling may be non-uniform. Row k contains the measurement at t_k and the voltage that acts
/// from t_k on. Each number is written as the shortest text that gives the same double when read.
/// Equal data therefore give equal bytes. An empty cell and `nan` are read as NaN. The reader takes
/// the most frequent of comma, semicolon and tab in the header as separator. With semicolons or
/// tabs, it also accepts decimal commas. A date with time of day (ISO 8601) is read as seconds
/// since 1970.
#include <array>
#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "crane/fields/shortest.hpp"
#include "crane/plant/coordinates.hpp"

namespace crane::recording {

inline constexpr std::array<std::string_view, 8> kCanonicalColumns{
    "time_s",
    plant::kCoordinates[plant::kTrolley].command_v,
    plant::kCoordinates[plant::kSlew].command_v,
    plant::kCoordinates[plant::kTrolley].column,
    plant::kCoordinates[plant::kSlew].column,
    plant::kCoordinates[plant::kSwingRadial].column,
    plant::kCoordinates[plant::kSwingTangential].column,
    plant::kCoordinates[plant::kHoist].column};

/// Columns of equal length.
struct Table {
  struct Column {
    std::string name;
    std::vector<double> values;
  };
  std::vector<Column> columns;

  [[nodiscard]] std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
  /// @return nullptr when no column has this name
  [[nodiscard]] const std::vector<double>* find(std::string_view name) const;
};

/// what() has the form "file:line: problem" or "file: problem".
class CsvError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Text of each value in a file.
using fields::shortest;

/// @throws CsvError when columns differ in length, or when a name is empty, occurs twice or contains a comma,
///   a quote or a line end
void write_csv(std::ostream& out, const Table& table);
/// As files::write_file(). @throws CsvError as above, files::WriteError
void write_csv(const std::filesystem::path& file, const Table& table);

/// Ignores blank lines and lines that begin with '#'. The first remaining line is the header.
/// @param wanted  columns to return, in this order; empty: all. A wanted column that the file does not
///   contain is omitted
/// @throws CsvError with file and line
[[nodiscard]] Table read_csv(const std::filesystem::path& file, const std::vector<std::string>& wanted = {});
[[nodiscard]] Table parse_csv(std::string_view text, const std::string& file,
                              const std::vector<std::string>& wanted = {});

}  // namespace crane::recording
