#pragma once
/// Checks of the wiring on the first motion of each axis.
#include <string>
#include <vector>

#include "tuning/crane_access.hpp"

namespace crane::tuning {

struct ProbeFinding {
  bool moved = false;         ///< true: the axis moved in both directions
  double friction_v = 0;      ///< mean of the voltages at the first motion in each direction; 0: no motion
  double friction_low_v = 0;  ///< lower bound of the friction in both directions
  std::vector<std::string> problems;  ///< wrong connections, one text each; empty: none
};

/// Compares the voltage of the axis with the motion of all encoders.
/// @param largest  true: the last probe, in which every axis within the priors moves
[[nodiscard]] ProbeFinding examine_probe(const Motion& motion, const configuration::Rig& rig,
                                         std::size_t axis, bool largest);

/// Compares the measured swing with the swing that the motion of the support causes.
/// @param axis  trolley: radial swing, slew: tangential swing
/// @return wrong connections, one text each; empty: none
[[nodiscard]] std::vector<std::string> examine_swing(const Motion& motion, const configuration::Rig& rig,
                                                     std::size_t axis);

}  // namespace crane::tuning
