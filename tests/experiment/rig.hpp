#pragma once
/// The travel of the dissertation's rig, for the checks of scenarios.
#include <numbers>

#include "crane/configuration/rig.hpp"

namespace crane::experiment {

inline configuration::Rig tower() {
  configuration::Rig rig;
  rig.name = "virginia_tech_tower";
  for (configuration::Drive& drive : rig.drives) drive.present = true;
  const auto travel = [&rig](std::size_t axis, double low, double high, double margin) {
    rig.drives[axis].low_limit = low;
    rig.drives[axis].high_limit = high;
    rig.drives[axis].soft_margin = margin;
  };
  constexpr double kDeg = std::numbers::pi / 180;
  travel(plant::kTrolley, 0.05, 1.25, 0.05);
  travel(plant::kSlew, -180 * kDeg, 180 * kDeg, 5 * kDeg);
  travel(plant::kHoist, 0.3, 1.4, 0.05);
  return rig;
}

}  // namespace crane::experiment
