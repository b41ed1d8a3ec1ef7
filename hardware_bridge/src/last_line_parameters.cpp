#include <algorithm>
#include <cmath>

#include "crane/bridge/last_line.hpp"
#include "crane/plant/pendulum.hpp"

namespace crane::bridge {
namespace {

/// Smallest gain: with the whole load mass; largest gain: without load.
void set_gains(AxisCheckParameters& axis, std::size_t i, const configuration::Rig& rig) {
  const auto& crane = rig.design.crane;
  const double load_kg = crane.load_mass_kg;
  if (i == plant::kTrolley) {
    axis.gain_high = crane.trolley_gain_mps2pv;
    axis.gain_low = axis.gain_high * crane.trolley_inertia_kg / (crane.trolley_inertia_kg + load_kg);
  } else if (i == plant::kSlew) {
    const double largest_radius_m =
        rig.drives[plant::kTrolley].present ? rig.drives[plant::kTrolley].high_limit : 0;
    const double outside_kgm2 = (crane.trolley_mass_kg + load_kg) * largest_radius_m * largest_radius_m;
    axis.gain_high = crane.slew_gain_radps2pv;
    axis.gain_low = axis.gain_high * crane.jib_inertia_kgm2 / (crane.jib_inertia_kgm2 + outside_kgm2);
  } else {
    axis.gain_high = axis.gain_low = crane.hoist_gain_mpspv;
    axis.lag_s = crane.hoist_lag_s;
  }
}

/// Voltage that balances the force of the load at the swing limit of the supervisor, V.
double load_pull_v(std::size_t i, const configuration::Rig& rig) {
  const auto& crane = rig.design.crane;
  const double force_n = crane.load_mass_kg * crane.gravity_mps2 * std::sin(rig.limits.swing_limit_rad);
  if (i == plant::kTrolley) return force_n / (crane.trolley_inertia_kg * crane.trolley_gain_mps2pv);
  if (i != plant::kSlew || !rig.drives[plant::kTrolley].present) return 0;
  const double torque_nm = force_n * rig.drives[plant::kTrolley].high_limit;
  return torque_nm / (crane.jib_inertia_kgm2 * crane.slew_gain_radps2pv);
}

AxisCheckParameters axis_check_parameters(const configuration::Rig& rig, std::size_t i) {
  const auto& drive = rig.drives[i];
  const auto& friction = rig.design.friction[i];
  AxisCheckParameters axis;
  static_cast<control::DriveLimits&>(axis) = drive;
  if (!drive.present) return axis;
  // Margins: temperature and dust raise the friction by up to 50 %; offsets are up to 0.5 V.
  constexpr double kOffset_v = 0.5, kFrictionMargin = 1.5, kCertainHoming_v = 0.8;
  constexpr double kResponse_v = 2.5;  // chosen: more than offset, ripple and gain error of a sound drive
  const double friction_v = std::max({friction.coulomb_positive_v, friction.coulomb_negative_v,
                                      friction.stiction_positive_v, friction.stiction_negative_v});
  axis.certain_motion_v = kOffset_v + kFrictionMargin * friction_v + load_pull_v(i, rig);
  axis.certain_homing_motion_v = kCertainHoming_v + friction_v;
  axis.response_margin_v = std::max(kResponse_v, load_pull_v(i, rig));
  axis.unit_per_count = 1 / rig.encoders[i].counts_per_unit;
  set_gains(axis, i, rig);
  return axis;
}

}  // namespace

LastLineParameters last_line_parameters(const configuration::Rig& rig) {
  LastLineParameters parameters;
  parameters.period_s = rig.period_s;
  parameters.stale_after_ticks = static_cast<std::uint64_t>(rig.ticks_in(rig.limits.stale_after_s));
  for (std::size_t i = 0; i < kDrives; ++i) parameters.axis[i] = axis_check_parameters(rig, i);
  constexpr double kSupervisorMargin = 1.5, kLargest_rad = 1.55;
  parameters.swing_limit_rad = std::min(kSupervisorMargin * rig.limits.swing_limit_rad, kLargest_rad);
  // Twice the largest rate of a free swing with this amplitude on the shortest cable.
  const double cable_m = rig.drives[plant::kHoist].present ? rig.drives[plant::kHoist].low_limit
                                                           : rig.start.position[plant::kHoist];
  parameters.swing_rate_max_radps =
      2 * parameters.swing_limit_rad * plant::swing_radps(rig.design.crane.gravity_mps2, cable_m);
  for (std::size_t i = 0; i < parameters.swing_present.size(); ++i)
    parameters.swing_present[i] = rig.measures(kDrives + i);
  return parameters;
}

}  // namespace crane::bridge
