#pragma once
/// One instant of a run: measured coordinates between two samples, and a State's coordinates by Output.
#include "crane/diagnosis/data.hpp"
#include "crane/plant/model.hpp"

namespace crane::diagnosis {

inline constexpr std::array kAllOutputs{kTrolleyPosition, kSlewAngle, kRadialSwing, kTangentialSwing};

struct Moment {
  double position = 0, rate = 0, acceleration = 0;
};
/// @param share of the period after `row`, in [0, 1]; zeros for a coordinate that was not measured
[[nodiscard]] Moment between(const Motion& motion, std::size_t row, double share, double period_s);

[[nodiscard]] inline double& position_of(plant::State& s, Output output) {
  switch (output) {
    case kTrolleyPosition:
      return s.trolley_m;
    case kSlewAngle:
      return s.slew_rad;
    case kRadialSwing:
      return s.radial_rad;
    default:
      return s.tangential_rad;
  }
}

[[nodiscard]] inline double& rate_of(plant::State& s, Output output) {
  switch (output) {
    case kTrolleyPosition:
      return s.trolley_mps;
    case kSlewAngle:
      return s.slew_radps;
    case kRadialSwing:
      return s.radial_radps;
    default:
      return s.tangential_radps;
  }
}

[[nodiscard]] inline double acceleration_of(const plant::Accelerations& a, Output output) {
  return std::array{a.trolley_mps2, a.slew_radps2, a.radial_radps2, a.tangential_radps2}[output];
}

[[nodiscard]] inline double measured_of(const plant::Measurement& m, Output output) {
  return std::array{m.trolley_m, m.slew_rad, m.radial_rad, m.tangential_rad}[output];
}

}  // namespace crane::diagnosis
