#pragma once
/// Outputs: the coordinates that sensors measure and the stepper can simulate. Kinematics of the outputs, and
/// access to the members of plant::State by Output.
#include <array>
#include <cstddef>

#include "crane/plant/coordinates.hpp"
#include "crane/plant/model.hpp"

namespace crane::stepper {

/// Measured coordinates, in the order of the arrays below.
enum Output : std::size_t { kTrolleyPosition = 0, kSlewAngle = 1, kRadialSwing = 2, kTangentialSwing = 3 };
inline constexpr std::size_t kOutputs = 4;
/// Coordinate of each output.
inline constexpr std::array<std::size_t, kOutputs> kCoordinateOf{
    plant::kTrolley, plant::kSlew, plant::kSwingRadial, plant::kSwingTangential};
/// Axis of the drive, or direction of the swing.
[[nodiscard]] constexpr const char* axis_of(Output output) {
  return plant::kCoordinates[kCoordinateOf[output]].axis;
}

inline constexpr std::array kAllOutputs{kTrolleyPosition, kSlewAngle, kRadialSwing, kTangentialSwing};

/// Motion of one coordinate: m or rad; m/s or rad/s; m/s2 or rad/s2.
struct Kinematics {
  double position = 0, rate = 0, acceleration = 0;
};

/// Kinematics of all measured coordinates at one instant. A coordinate without a measurement is 0.
struct MeasuredKinematics {
  std::array<Kinematics, kOutputs> output;
  Kinematics cable;
};

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

}  // namespace crane::stepper
