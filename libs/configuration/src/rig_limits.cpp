#include "rig_sections.hpp"

namespace crane::configuration {

void read_limits(TomlTable& root, Rig& rig) {
  TomlTable table = root.table("limits");
  read_section(table, control::kOperatingLimitFields, rig.limits, &rig);
  check_plausible_limits(table, rig);
}

void read_start(TomlTable& root, Rig& rig) {
  TomlTable table = root.table("start");
  Start& start = rig.start;
  // Without a trolley the slew axis has the inertia of the jib only: gamma'' = K_mgamma V, with x = 0.
  if (!rig.drives[plant::kTrolley].present) start.position[plant::kTrolley] = 0;
  read_section(table, kStartFields, start, &rig);
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    const Drive& drive = rig.drives[i];
    const plant::Coordinate& axis = plant::kCoordinates[i];
    if (drive.present && drive.low_limit < drive.high_limit &&
        (start.position[i] < drive.low_limit || start.position[i] > drive.high_limit))
      table.problem(axis.column, "must be inside the limits of the " + std::string(axis.name) + " drive");
  }
  if (start.position[plant::kHoist] + start.cable_length_offset_m <= 0)
    table.problem("cable_length_offset_m", "must leave a cable longer than 0");
}

}  // namespace crane::configuration
