#pragma once
/// Converts topic samples to the inputs of the control laws, and outputs of the laws to topic samples.
#include "crane/control/law.hpp"
#include "crane/topics.hpp"

namespace crane::runtime {

/// m, rad, m: trolley, slew, cable.
[[nodiscard]] inline std::array<double, control::kAxes> positions(const msg::State& state) {
  return {state.trolley_position_m, state.slew_angle_rad, state.cable_length_m};
}
[[nodiscard]] inline std::array<double, control::kAxes> speeds(const msg::State& state) {
  return {state.trolley_speed_mps, state.slew_speed_radps, state.cable_speed_mps};
}

[[nodiscard]] inline control::Measurement measurement(const msg::State& state) {
  return {.position = positions(state),
          .speed = speeds(state),
          .swing_radial_rad = state.swing_radial_rad,
          .swing_radial_radps = state.swing_radial_radps,
          .swing_tangential_rad = state.swing_tangential_rad,
          .swing_tangential_radps = state.swing_tangential_radps,
          .applied_v = {state.applied_v[0], state.applied_v[1], state.applied_v[2]}};
}

[[nodiscard]] inline control::Reference reference(const msg::AxisReference (&axes)[control::kAxes]) {
  control::Reference result;
  for (std::size_t i = 0; i < control::kAxes; ++i)
    result[i] = {.position = axes[i].position, .speed = axes[i].speed, .acceleration = axes[i].acceleration};
  return result;
}

[[nodiscard]] inline control::Reference reference(const msg::Reference& sample) {
  control::Reference result = reference(sample.axis);
  result.swing = {sample.swing_rad[0], sample.swing_radps[0], sample.swing_rad[1], sample.swing_radps[1]};
  for (std::size_t i = 0; i < control::kAxes; ++i) {
    result[i].start = sample.start[i];
    result.feed_forward_v[i] = sample.feed_forward_v[i];
  }
  return result;
}

inline void assign(msg::AxisReference (&axes)[control::kAxes], const control::Reference& reference) {
  for (std::size_t i = 0; i < control::kAxes; ++i)
    axes[i] = {reference[i].position, reference[i].speed, reference[i].acceleration};
}

inline void assign(msg::Reference& sample, const control::Reference& reference) {
  assign(sample.axis, reference);
  sample.swing_rad[0] = reference.swing.radial_rad;
  sample.swing_rad[1] = reference.swing.tangential_rad;
  sample.swing_radps[0] = reference.swing.radial_radps;
  sample.swing_radps[1] = reference.swing.tangential_radps;
  for (std::size_t i = 0; i < control::kAxes; ++i) {
    sample.start[i] = reference[i].start;
    sample.feed_forward_v[i] = reference.feed_forward_v[i];
  }
}

inline void assign(double (&field)[control::kAxes], const std::array<double, control::kAxes>& values) {
  for (std::size_t i = 0; i < control::kAxes; ++i) field[i] = values[i];
}

[[nodiscard]] inline std::array<double, control::kAxes> values(const double (&field)[control::kAxes]) {
  return {field[0], field[1], field[2]};
}

/// Header of a sample that is computed from `cause`: same tick and sample time. publish() sets source and
/// epoch.
[[nodiscard]] inline msg::Header answer_to(const msg::Header& cause) {
  return {
      .tick = cause.tick, .sample_time_ns = cause.sample_time_ns, .source = crane_SOURCE_NONE, .epoch = 0};
}

}  // namespace crane::runtime
