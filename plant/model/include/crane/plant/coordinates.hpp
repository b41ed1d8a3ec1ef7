#pragma once
/// The table of the coordinates of a crane: names, units, columns. Order: axes (Axis), swings; encoders and
/// board counters have the same order.
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "crane/plant/parameters.hpp"

namespace crane::plant {

/// Indices of the swings, after those of the axes (Axis).
inline constexpr std::size_t kSwingRadial = 3, kSwingTangential = 4;
inline constexpr std::size_t kCoordinateCount = 5;

struct Coordinate {
  const char* name;       ///< section of a rig file: [encoder.NAME]
  const char* axis;       ///< name of the place where a term acts (TermSetting::axis)
  const char* unit;       ///< "m" or "rad"
  const char* column;     ///< canonical column of a table; key in [start] of a rig file
  const char* command_v;  ///< canonical column of the command; nullptr for a coordinate without a drive
  const char* reference;  ///< column of the planner's reference; nullptr for a coordinate without a drive
};
inline constexpr std::array<Coordinate, kCoordinateCount> kCoordinates{{
    {"trolley", "trolley", "m", "trolley_position_m", "trolley_voltage_v", "trolley_reference_m"},
    {"slew", "slew", "rad", "slew_angle_rad", "slew_voltage_v", "slew_reference_rad"},
    {"hoist", "hoist", "m", "cable_length_m", "hoist_voltage_v", "hoist_reference_m"},
    {"swing_radial", "radial", "rad", "swing_radial_rad", nullptr, nullptr},
    {"swing_tangential", "tangential", "rad", "swing_tangential_rad", nullptr, nullptr},
}};

/// "trolley", "slew", "hoist"
[[nodiscard]] inline std::vector<std::string> drive_names() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kAxes; ++i) names.emplace_back(kCoordinates[i].name);
  return names;
}

}  // namespace crane::plant
