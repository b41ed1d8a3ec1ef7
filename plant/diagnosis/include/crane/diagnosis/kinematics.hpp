#pragma once
/// Measured kinematics at one instant, interpolated between rows, and access to a State by Output.
#include "crane/diagnosis/data.hpp"
#include "crane/plant/model.hpp"

namespace crane::diagnosis {

inline constexpr std::array kAllOutputs{kTrolleyPosition, kSlewAngle, kRadialSwing, kTangentialSwing};

/// m or rad, per s, per s2.
struct Kinematics {
  double position = 0, rate = 0, acceleration = 0;
};
/// Cubic Hermite interpolation of position and rate, linear of the acceleration.
/// @param share of the period after `row`, in [0, 1]. @return zeros for a coordinate without a measurement
[[nodiscard]] Kinematics between(const Motion& motion, std::size_t row, double share, double period_s);

/// The same at a row.
[[nodiscard]] inline Kinematics at_row(const Motion& motion, std::size_t row) {
  if (motion.position.empty()) return {};
  return {motion.position[row], motion.rate[row], motion.acceleration[row]};
}

/// All measured coordinates at one instant; zeros without a measurement.
struct MeasuredKinematics {
  std::array<Kinematics, kOutputs> output;
  Kinematics cable;
};

/// Kinematics at the middle of each of the `steps` equal steps of every period, in order of time.
[[nodiscard]] std::vector<MeasuredKinematics> mid_step_kinematics(const std::array<Motion, kOutputs>& motion,
                                                                  const Motion& cable, int steps,
                                                                  double period_s);

inline constexpr std::array kPositionOf{&plant::State::trolley_m, &plant::State::slew_rad,
                                        &plant::State::radial_rad, &plant::State::tangential_rad};
inline constexpr std::array kRateOf{&plant::State::trolley_mps, &plant::State::slew_radps,
                                    &plant::State::radial_radps, &plant::State::tangential_radps};
inline constexpr std::array kAccelerationOf{
    &plant::Accelerations::trolley_mps2, &plant::Accelerations::slew_radps2,
    &plant::Accelerations::radial_radps2, &plant::Accelerations::tangential_radps2};
inline constexpr std::array kMeasuredOf{&plant::Measurement::trolley_m, &plant::Measurement::slew_rad,
                                        &plant::Measurement::radial_rad, &plant::Measurement::tangential_rad};

[[nodiscard]] inline double& position_of(plant::State& s, Output output) { return s.*kPositionOf[output]; }
[[nodiscard]] inline double& rate_of(plant::State& s, Output output) { return s.*kRateOf[output]; }
[[nodiscard]] inline double acceleration_of(const plant::Accelerations& a, Output output) {
  return a.*kAccelerationOf[output];
}
[[nodiscard]] inline double measured_of(const plant::Measurement& m, Output output) {
  return m.*kMeasuredOf[output];
}

}  // namespace crane::diagnosis
