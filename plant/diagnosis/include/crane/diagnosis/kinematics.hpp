#pragma once
/// Measured kinematics at one instant, interpolated between rows.
#include <vector>

#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {

using stepper::kAllOutputs, stepper::Kinematics, stepper::MeasuredKinematics;

/// Cubic Hermite interpolation of position and rate, linear of the acceleration.
/// @param share of the period after `row`, in [0, 1]. @return zeros for a coordinate without a measurement
[[nodiscard]] Kinematics between(const Motion& motion, std::size_t row, double share, double period_s);

/// The same at a row.
[[nodiscard]] inline Kinematics at_row(const Motion& motion, std::size_t row) {
  if (motion.position.empty()) return {};
  return {motion.position[row], motion.rate[row], motion.acceleration[row]};
}

/// Kinematics at the middle of each of the `steps` equal steps of every period, in order of time.
[[nodiscard]] std::vector<MeasuredKinematics> mid_step_kinematics(const std::array<Motion, kOutputs>& motion,
                                                                  const Motion& cable, int steps,
                                                                  double period_s);

}  // namespace crane::diagnosis
