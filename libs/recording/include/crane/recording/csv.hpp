#pragma once
/// Measured data as CSV: comma, one header line, one number per cell. Canonical columns, any subset a rig
/// has, `time_s` first, uniform or not; row k holds the measurement at t_k and the command applied from t_k
/// on. Further columns follow the canonical ones. Numbers are the shortest text that reads back as the same
/// double, so the same data give the same bytes. An empty cell and `nan` are NaN.
#include <array>
#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace crane::recording {

inline constexpr std::array<std::string_view, 8> kCanonicalColumns{
    "time_s",         "trolley_voltage_v", "slew_voltage_v",       "trolley_position_m",
    "slew_angle_rad", "swing_radial_rad",  "swing_tangential_rad", "cable_length_m"};

/// Columns of equal length.
struct Table {
  struct Column {
    std::string name;
    std::vector<double> values;
  };
  std::vector<Column> columns;

  [[nodiscard]] std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
  /// @return nullptr when there is none of that name
  [[nodiscard]] const std::vector<double>* find(std::string_view name) const;
};

/// "file:line: what is wrong", or file and reason.
class CsvError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Shortest text that reads back as `value`: "0.01", "1e-07", "nan".
[[nodiscard]] std::string shortest(double value);

/// @throws CsvError when columns differ in length, a name is empty, repeated or holds a comma, or writing
/// fails
void write_csv(std::ostream& out, const Table& table);
void write_csv(const std::filesystem::path& file, const Table& table);

/// Blank lines and lines beginning with '#' are passed over; the first other line is the header.
/// @param wanted columns to keep, in this order; empty: all. A wanted column the file lacks is left out.
/// @throws CsvError naming file and line
[[nodiscard]] Table read_csv(const std::filesystem::path& file, const std::vector<std::string>& wanted = {});
[[nodiscard]] Table parse_csv(std::string_view text, const std::string& file,
                              const std::vector<std::string>& wanted = {});

}  // namespace crane::recording
