#pragma once
/// Converts another laboratory's columns to canonical names, units, signs and zeros, and selects rows
/// (docs/data.md). A mapping file:
///
///   from_s = 0.2                                    # canonical time; to_s likewise
///   [columns]
///   time_s = { column = "t_s" }
///   swing_radial_rad = { column = "theta_deg", factor = 0.017453292519943295, sign = -1, offset = 3.14159 }
///   slew_voltage_v = { column = "duty", times = ["supply_v"], factor = 0.00113 }
///   trolley_voltage_v = { column = "current_a", unit = "A", per_volt = 0.5 }
///   slew_angle_rad = { column = "angle_deg", factor = 0.017453292519943295, wraps = 6.283185307179586 }
///   cable_length_m = { value = 0.7 }
///   [enable]
///   column = "torque_enable"                        # rows where it is not 0
///   [stretches]
///   "sac.csv" = [0.0, 3.9]                          # from, to, from, to ...
///   [runs."heavy.csv"]
///   load_mass_kg = 3.2                              # cable_length_m likewise
///
///   canonical = sign * factor * column * times[0] * ... + offset
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "crane/recording/csv.hpp"

namespace crane::diagnosis {

struct MappedColumn {
  std::string canonical;           ///< one of recording::kCanonicalColumns
  std::string column;              ///< name in the other file; empty: `offset` in every row
  double factor = 1;               ///< canonical units per unit of the column, > 0
  int sign = 1;                    ///< 1 or -1
  double offset = 0;               ///< canonical unit; added last
  std::vector<std::string> times;  ///< further columns; their values multiply `column`, row by row
  std::string unit;                ///< of a command other than V, for messages
  double wraps = 0;                ///< range at which the column wraps, canonical unit; unwrapped. 0: no wrap
};

/// Closed interval of times; rows within the interval are selected.
struct Stretch {
  double from_s = -std::numeric_limits<double>::infinity(), to_s = std::numeric_limits<double>::infinity();
};

/// Constants of one run; 0: as in the rig file.
struct RunValues {
  double cable_length_m = 0, load_mass_kg = 0;
};

struct Mapping {
  std::vector<MappedColumn> columns;
  Stretch whole;       ///< of every file
  std::string enable;  ///< column; empty: none
  std::map<std::string, std::vector<Stretch>>
      stretches;                          ///< by file name without folders; none: the whole file
  std::map<std::string, RunValues> runs;  ///< likewise
};

/// Column of `canonical` with the number of the stretch, if there are several stretches. The state is lost
/// between two stretches.
inline constexpr const char* kStretchColumn = "stretch";
/// Column of the load mass [kg], constant, if the mapping gives it.
inline constexpr const char* kLoadMassColumn = "load_mass_kg";

/// @throws configuration::ConfigurationError with every problem as "file:line: name = value: rule"
[[nodiscard]] Mapping load_mapping(const std::filesystem::path& file);
[[nodiscard]] Mapping parse_mapping(const std::string& text, const std::string& file);

/// Canonical columns in canonical order, with the selected rows. Columns that already have a canonical name
/// and are not mapped are kept.
/// @param name of the file, for messages and for the mapping's stretches and runs
/// @throws DataError that names every column of the mapping that the table does not contain
[[nodiscard]] recording::Table canonical(const recording::Table& table, const Mapping& mapping,
                                         const std::string& name);

}  // namespace crane::diagnosis
