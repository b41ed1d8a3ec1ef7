#pragma once
/// Another laboratory's columns, names, units, signs and zeros, turned into the canonical ones
/// (docs/data.md). A mapping file:
///
///   [columns]
///   time_s = { column = "t_s" }
///   swing_radial_rad = { column = "theta_deg", factor = 0.017453292519943295, sign = -1, offset = 3.14159 }
///
///   canonical = sign * factor * column + offset
#include <filesystem>
#include <string>
#include <vector>

#include "crane/recording/csv.hpp"

namespace crane::diagnosis {

struct MappedColumn {
  std::string canonical;  ///< one of recording::kCanonicalColumns
  std::string column;     ///< name in the other file
  double factor = 1;      ///< canonical units per unit of the column, > 0
  int sign = 1;           ///< 1 or -1
  double offset = 0;      ///< canonical unit; added last
};
using Mapping = std::vector<MappedColumn>;

/// @throws configuration::ConfigurationError with every problem as "file:line: name = value: rule"
[[nodiscard]] Mapping load_mapping(const std::filesystem::path& file);
[[nodiscard]] Mapping parse_mapping(const std::string& text, const std::string& file);

/// Canonical columns only, in their order. A column that the mapping does not name is taken as it is where it
/// has a canonical name already.
/// @param name of the file, for messages
/// @throws DataError naming every column that the mapping wants and the table lacks
[[nodiscard]] recording::Table canonical(const recording::Table& table, const Mapping& mapping,
                                         const std::string& name);

}  // namespace crane::diagnosis
