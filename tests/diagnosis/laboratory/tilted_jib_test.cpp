/// Data of laboratories with a jib or rail out of the horizontal, from an independent point-mass crane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../../plant/point_mass_crane.hpp"
#include "crane/diagnosis/diagnosis.hpp"
#include "laboratory/expect_cause.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kTilt_rad = -0.022, kTolerance_rad = 0.02 * 0.022, kPeriod_s = 0.01;
constexpr int kStepsPerRow = 20;

struct Lab {
  test::PointMassCrane crane{};
  double cable_m = 1, start_m = 1;
  double swing_offset_rad = 0;
};

/// A run under position control. The references follow two tones of random phases each.
recording::Table recorded(const Lab& lab, double duration_s, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> gauss;
  recording::Table table;
  table.columns = {
      {"time_s", {}}, {"trolley_voltage_v", {}}, {"trolley_position_m", {}}, {"swing_radial_rad", {}}};
  if (lab.crane.slews)
    for (const char* more : {"slew_voltage_v", "slew_angle_rad", "swing_tangential_rad"})
      table.columns.push_back({more, {}});
  std::array<double, 4> phase{};
  for (double& one : phase) one = 3.1 * uniform(random);
  const auto tones = [&](double t, std::size_t axis) {
    return std::sin(0.7 * t + phase[2 * axis]) + 0.5 * std::sin(1.9 * t + phase[2 * axis + 1]);
  };
  test::PointMassCrane crane = lab.crane;
  crane.x = lab.start_m;
  crane.hang(lab.cable_m);
  for (int row = 0; row * kPeriod_s < duration_s; ++row) {
    const double t = row * kPeriod_s, fade = std::min(1.0, t / 2);
    const std::array<double, 2> volts{
        12 * (lab.start_m + 0.25 * fade * tones(t, 0) - crane.x) - 4 * crane.x_rate,
        crane.slews ? 14 * (0.8 * fade * tones(t, 1) - crane.gamma) - 5 * crane.gamma_rate : 0};
    const auto swing = crane.swing_rad();
    const auto counted = [&](double value, double count) {
      return count * std::round(value / count + 0.5 * gauss(random));
    };
    const auto write = [&](std::size_t column, double value) {
      table.columns[column].values.push_back(value);
    };
    write(0, t);
    write(1, volts[0]);
    write(2, counted(crane.x, 2e-5));
    write(3, counted(swing[0] + lab.swing_offset_rad, 2e-4));
    if (crane.slews) {
      write(4, volts[1]);
      write(5, counted(crane.gamma, 4e-5));
      write(6, counted(swing[1], 2e-4));
    }
    for (int i = 0; i < kStepsPerRow; ++i) crane.step(volts, kPeriod_s / kStepsPerRow);
  }
  return table;
}

Diagnosis diagnosed(const Lab& lab, const configuration::Rig& rig) {
  const auto run = [&](std::uint64_t seed) {
    return load_run(recorded(lab, 12, seed), rig, "tilt_" + std::to_string(seed) + ".csv").runs.at(0);
  };
  Request request;
  request.most_effects = 1;
  return diagnose(rig, {run(1), run(2)}, {run(3)}, request);
}

/// The rig file of the tower of the dissertation with the friction and the cable length of `lab`.
configuration::Rig tower_of(const Lab& lab) {
  configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
  for (plant::TermSetting& term : rig.terms) {
    const std::size_t axis = term.axis == "trolley" ? 0 : 1;
    term.parameters = {{"coulomb_positive_v", lab.crane.coulomb_v[axis]},
                       {"coulomb_negative_v", lab.crane.coulomb_v[axis]},
                       {"viscous_positive_vspm", lab.crane.viscous_vs[axis]},
                       {"viscous_negative_vspm", lab.crane.viscous_vs[axis]}};
  }
  std::erase_if(rig.terms, [](const plant::TermSetting& t) { return t.axis == "hoist"; });
  rig.start.position[plant::kHoist] = lab.cable_m;
  return rig;
}

Lab tower_lab() {
  Lab lab;
  lab.crane.coulomb_v = {0.4, 0.3};
  lab.crane.viscous_vs = {1.2, 0.4};
  return lab;
}

TEST(TiltOfALaboratory, IsNamedOnATowerWhoseSlewAxisIsVertical) {
  Lab lab = tower_lab();
  lab.crane.tilt_rad = kTilt_rad;
  expect_cause(diagnosed(lab, tower_of(lab)), "jib_tilt", kTilt_rad, kTolerance_rad);
}

TEST(TiltOfALaboratory, IsNotNamedForTheOffsetOfASwingEncoder) {
  Lab lab = tower_lab();
  lab.swing_offset_rad = kTilt_rad;
  expect_cause(diagnosed(lab, tower_of(lab)), "swing_offset", kTilt_rad, kTolerance_rad);
}

TEST(TiltOfALaboratory, IsNamedOnAGantryWhoseRailIsNotLevel) {
  Lab lab{.cable_m = 1.5};
  lab.crane.slews = false;
  lab.crane.tilt_rad = kTilt_rad;
  lab.crane.inertia_kg = 12, lab.crane.carriage_kg = 4, lab.crane.load_kg = 3, lab.crane.trolley_mps2pv = 1.2;
  configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/gantry.toml");
  rig.start.position[plant::kHoist] = lab.cable_m;
  expect_cause(diagnosed(lab, rig), "jib_tilt", kTilt_rad, kTolerance_rad);
}

}  // namespace
}  // namespace crane::diagnosis
