/// The forces of the trolley and of the jib along the path of a stick, (2.17), (2.19) of H. M. Omar, Control
/// of Gantry and Tower Cranes.
#include "crane/control/stick.hpp"
#include "crane/plant/motion_terms.hpp"

namespace crane::control {

namespace motion = plant::motion;

Volts feed_forward(const Design& design, const StickLimits& limits, const StickMemory& memory) noexcept {
  if (limits.shaping == Shaping::none || at_rest(memory)) return {};
  const StickPoint &after = memory.path[0], &at = memory.path[1], &before = memory.path[2];
  const double h = limits.period_s;
  const auto rate = [h](double a, double b) { return (a - b) / (2 * h); };
  const auto second = [h](double a, double b, double c) { return (a - 2 * b + c) / (h * h); };
  const auto axis_rate = [&](std::size_t i) { return rate(after.position[i], before.position[i]); };
  const auto axis_second = [&](std::size_t i) {
    return second(after.position[i], at.position[i], before.position[i]);
  };
  const double f2 = second(after.radial_rad, at.radial_rad, before.radial_rad);
  const double t2 = second(after.tangential_rad, at.tangential_rad, before.tangential_rad);
  const plant::Parameters& p = design.crane;
  const motion::Motion<double> state{.angles = {at.radial_rad, at.tangential_rad},
                                     .trolley_m = at.position[kTrolley],
                                     .trolley_mps = axis_rate(kTrolley),
                                     .radial_radps = rate(after.radial_rad, before.radial_rad),
                                     .slew_radps = axis_rate(kSlew),
                                     .tangential_radps = rate(after.tangential_rad, before.tangential_rad),
                                     .cable_m = at.position[kHoist],
                                     .cable_mps = axis_rate(kHoist),
                                     .cable_mps2 = axis_second(kHoist)};
  const auto m = motion::mass(p, state.angles, state.trolley_m, state.cable_m);
  const double x2 = axis_second(kTrolley), g2 = axis_second(kSlew);
  constexpr auto kMoving = motion::Cable::moving;
  const double trolley_n =
      m.m11 * x2 + m.m12 * f2 + m.m13 * g2 + m.m14 * t2 + motion::trolley_bias<kMoving>(p, state);
  const double slew_nm =
      m.m13 * x2 + m.m23 * f2 + m.m33 * g2 + m.m34 * t2 + motion::slew_bias<kMoving>(p, state);
  Volts volts{};
  if (limits.axis[kTrolley].speed > 0)
    volts[kTrolley] = trolley_n / (p.trolley_inertia_kg * p.trolley_gain_mps2pv);
  if (limits.axis[kSlew].speed > 0) volts[kSlew] = slew_nm / (p.jib_inertia_kgm2 * p.slew_gain_radps2pv);
  return volts;
}

}  // namespace crane::control
