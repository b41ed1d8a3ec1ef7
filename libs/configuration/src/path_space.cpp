#include "crane/configuration/path_space.hpp"

namespace crane::configuration {

control::PathSpace path_space_of(const Rig& rig) {
  control::PathSpace space{.zones = rig.zones,
                           .clearance = rig.clearance,
                           .gravity_mps2 = rig.design.crane.gravity_mps2,
                           .cable_measured = rig.measures(plant::kHoist),
                           .cable_m = rig.start.position[plant::kHoist]};
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    const Drive& drive = rig.drives[i];
    if (!drive.present) continue;
    space.axis[i] = {.present = true,
                     .low = drive.low_limit + drive.soft_margin,
                     .high = drive.high_limit - drive.soft_margin,
                     .speed = drive.reference_speed,
                     .acceleration = drive.reference_acceleration};
    if (rig.planning.limits_jerk) space.axis[i].jerk = drive.reference_jerk;
  }
  return space;
}

}  // namespace crane::configuration
