#include "crane/control/schedule.hpp"

#include <algorithm>
#include <cmath>

#include "crane/plant/pendulum.hpp"

namespace crane::control {
namespace {

// Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes (schedule.hpp).

constexpr double kBound = 1e6;  // larger than any value of a crane; products of such values do not overflow

double bounded(double value) noexcept { return std::clamp(value, -kBound, kBound); }

double square(double value) noexcept { return value * value; }

}  // namespace

Measurement bounded(const Measurement& measured) noexcept {
  Measurement result = measured;
  for (auto& position : result.position) position = bounded(position);
  for (auto& speed : result.speed) speed = bounded(speed);
  for (auto& volts : result.applied_v) volts = bounded(volts);
  for (double* swing : {&result.swing_radial_rad, &result.swing_radial_radps, &result.swing_tangential_rad,
                        &result.swing_tangential_radps})
    *swing = bounded(*swing);
  return result;
}

Reference bounded(const Reference& reference) noexcept {
  Reference result = reference;
  for (auto& axis : result)
    axis = {bounded(axis.position), bounded(axis.speed), bounded(axis.acceleration), bounded(axis.start)};
  auto& swing = result.swing;
  swing = {bounded(swing.radial_rad), bounded(swing.radial_radps), bounded(swing.tangential_rad),
           bounded(swing.tangential_radps)};
  for (double& volts : result.feed_forward_v) volts = bounded(volts);
  return result;
}

Schedule schedule(const Design& design, const Measurement& measured) noexcept {
  Schedule at;
  at.cable_length_m =
      std::clamp(measured.position[kHoist], design.shortest_cable_length_m, design.longest_cable_length_m);
  at.trolley_position_m = bounded(measured.position[kTrolley]);
  at.inverse_position_pm = at.trolley_position_m /
                           std::max(square(at.trolley_position_m), square(design.minimum_trolley_position_m));
  at.load_period_s = plant::swing_period_s(design.crane.gravity_mps2, at.cable_length_m);
  return at;
}

double trolley_volts(const plant::Parameters& crane, const Schedule& at, double vbar_x) noexcept {
  return at.cable_length_m / (crane.trolley_gain_mps2pv * square(at.load_period_s)) * vbar_x;  // (3.37)
}

double slew_volts(const plant::Parameters& crane, const Schedule& at, double vbar_y) noexcept {
  const double inertia = 1 + crane.trolley_to_jib_ratio() * square(at.trolley_position_m);
  return -at.cable_length_m * inertia * at.inverse_position_pm /
         (crane.slew_gain_radps2pv * square(at.load_period_s)) * vbar_y;  // (3.38)
}

Volts load_force_volts(const plant::Parameters& crane, const Measurement& measured) noexcept {
  const double g = crane.gravity_mps2;
  Volts result{};
  result[kTrolley] =  // (3.37)
      crane.load_to_trolley_ratio() * g * measured.swing_radial_rad / crane.trolley_gain_mps2pv;
  result[kSlew] =  // (3.38)
      -crane.load_to_jib_ratio() * g * measured.position[kTrolley] * measured.swing_tangential_rad /
      crane.slew_gain_radps2pv;
  return result;
}

}  // namespace crane::control
