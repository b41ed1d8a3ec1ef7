/// Compares the crane of the generator with the simulated plant: the same crane, with independent derivation,
/// code and integrator.
#include <gtest/gtest.h>

#include <cmath>

#include "crane.hpp"
#include "crane/simulator/integrator.hpp"

namespace {

namespace plant = crane::plant;

constexpr int kTicks = 300;  // 3 s, open loop

/// Voltages that move both axes, with reversals.
truth::Volts command(int tick) {
  const double t = tick * 0.01;
  return {2.5 * std::sin(2.1 * t) + 1.5 * std::sin(5.3 * t),
          1.8 * std::cos(1.7 * t) - 1.2 * std::sin(4.1 * t)};
}

/// Largest difference of trolley, slew, radial and tangential swing.
std::array<double, 4> difference(const truth::Physics& physics,
                                 const std::vector<plant::TermSetting>& terms) {
  truth::Crane crane{physics,
                     {.quantised = false},
                     {.trolley_m = 0.6, .slew_rad = 0.2, .radial_rad = 0.1, .tangential_rad = -0.05},
                     1,
                     "agreement"};
  const plant::Model model{plant::Parameters{}, terms};
  crane::simulator::Integrator integrator{model, {.relative = 1e-10, .absolute = 1e-10}};
  plant::State state{.trolley_m = 0.6, .radial_rad = 0.1, .slew_rad = 0.2, .tangential_rad = -0.05};
  std::array<double, 4> largest{};
  for (int i = 0; i < kTicks; ++i) {
    const truth::Volts v = command(i);
    crane.advance(v);
    plant::Actuation actuation;
    actuation.drive_v = {v[0], v[1], 0};
    integrator.advance(state, actuation, 0.01);
    const truth::Sensed sensed = crane.sense();
    const std::array<double, 4> other{state.trolley_m, state.slew_rad, state.radial_rad,
                                      state.tangential_rad};
    for (std::size_t k = 0; k < largest.size(); ++k)
      largest[k] = std::max(largest[k], std::abs(sensed[k] - other[k]));
  }
  return largest;
}

plant::TermSetting friction(const std::string& axis, double b_plus, double b_minus, double c_plus,
                            double c_minus) {
  return {"drive_friction",
          axis,
          {{"viscous_positive_vspm", b_plus},
           {"viscous_negative_vspm", b_minus},
           {"coulomb_positive_v", c_plus},
           {"coulomb_negative_v", c_minus},
           {"smoothing_speed", 0.0005}}};
}

/// With a hundredth of the usual tolerances of the plant, both integrators have errors below 1e-6. No other
/// difference is permitted.
TEST(TruthAndPlant, MoveAlikeWithoutFriction) {
  truth::Physics physics = truth::rig("tower");
  for (truth::Drive& d : physics.drive) d.coulomb_v = d.viscous_vs = {};
  for (const double d : difference(physics, {})) EXPECT_LT(d, 1e-6);
}

/// The friction at standstill differs: bristles in the generator, a smoothed step of 0.5 mm/s in the plant.
/// At each reversal this difference shifts the start of the motion by about a millisecond, the time in which
/// the smoothed friction rises.
TEST(TruthAndPlant, MoveAlikeWithFriction) {
  const auto d = difference(truth::rig("tower"),
                            {friction("trolley", 1.5, 6, 0.9, 1.2), friction("slew", 0.15, 0.05, 0.7, 0.6)});
  EXPECT_LT(d[0], 1e-3);
  EXPECT_LT(d[1], 2e-3);
  EXPECT_LT(d[2], 1e-3);
  EXPECT_LT(d[3], 2e-3);
}

}  // namespace
