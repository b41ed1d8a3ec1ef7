/// Backlash in the data of a laboratory whose rig file contains the friction of the whole healthy axis.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "crane/diagnosis/diagnosis.hpp"
#include "laboratory/expect_cause.hpp"
#include "laboratory/strange_lab.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kFriction_v = 0.15, kGap_m = 0.006, kCarriageShare = 0.25;
/// Share of the command of the laboratory; the load then swings by up to 0.3 rad.
constexpr double kCommandShare = 0.5;

/// The gantry of the laboratory with a gap between the motor, whose encoder is measured, and the carriage
/// that carries the load. Friction is continuous at standstill; the flanks are a spring of 60 Hz with a
/// damper.
struct GapGantry {
  strange::Gantry crane{};
  double motor_friction_v = kFriction_v, guide_friction_v = 0;
};

std::vector<strange::Instant> moved_with_gap(const GapGantry& g, double duration_s, double phase_s) {
  using State = std::array<double, 6>;  // motor x, x', carriage x, x', swing r, r'
  const strange::Gantry& c = g.crane;
  const double carriage_kg = kCarriageShare * c.inertia_kg, motor_kg = c.inertia_kg - carriage_kg;
  const double stiffness = std::pow(2 * std::numbers::pi * 60, 2) * carriage_kg * motor_kg / c.inertia_kg;
  const double damping = 40 * motor_kg, per_volt_n = c.inertia_kg * c.gain_mps2pv;
  const auto dry_n = [&](double level_v, double speed) {
    return per_volt_n * level_v * std::tanh(speed / 5e-4);
  };
  const auto slope = [&](const State& s, double volts) {
    const double apart = s[0] - s[2], depth = std::abs(apart) - kGap_m / 2;
    const double side = std::copysign(1.0, apart);
    const double contact_n =
        depth > 0 ? side * std::max(0.0, stiffness * depth + damping * side * (s[1] - s[3])) : 0;
    const double sine = std::sin(s[4]), cosine = std::cos(s[4]);
    const double motor = (per_volt_n * volts - dry_n(g.motor_friction_v, s[1]) - contact_n) / motor_kg;
    const double force_n = contact_n - dry_n(g.guide_friction_v, s[3]) -
                           c.load_kg * sine * (c.gravity_mps2 * cosine + c.cable_m * s[5] * s[5]);
    const double carriage = force_n / (carriage_kg + c.load_kg * sine * sine);
    return State{s[1], motor, s[3], carriage, s[5], (carriage * cosine - c.gravity_mps2 * sine) / c.cable_m};
  };
  constexpr int kParts = 5;
  const double h = strange::kTick_s / kParts;
  State s{1, 0, 1, 0, 0, 0};
  std::vector<strange::Instant> all;
  for (int k = 0; k * strange::kTick_s < duration_s; ++k) {
    const double time_s = k * strange::kTick_s;
    const double volts = kCommandShare * strange::rich_command(time_s + phase_s);
    all.push_back({time_s, volts, s[0], s[4]});
    for (int part = 0; part < kParts; ++part) {
      const State first = slope(s, volts);
      State middle = s;
      for (std::size_t i = 0; i < s.size(); ++i) middle[i] += 0.5 * h * first[i];
      const State second = slope(middle, volts);
      for (std::size_t i = 0; i < s.size(); ++i) s[i] += h * second[i];
    }
  }
  return all;
}

Diagnosis diagnosed(const GapGantry& crane) {
  configuration::Rig rig = configuration::load_rig(std::string{CRANE_RIGS} + "/gantry.toml");
  rig.terms.push_back({"drive_friction",
                       "trolley",
                       {{"coulomb_positive_v", kFriction_v}, {"coulomb_negative_v", kFriction_v}}});
  const auto run = [&](std::uint64_t seed) {
    strange::Recording lab;
    lab.seed = seed;
    lab.swing_noise_rad = 2e-4;
    const auto table = strange::recorded(moved_with_gap(crane, 20, 7.0 * static_cast<double>(seed)), lab);
    return load_run(table, rig, "gap_" + std::to_string(seed) + ".csv").runs.at(0);
  };
  Request request;
  request.most_effects = 1;
  return diagnose(rig, {run(1), run(2)}, {run(3)}, request);
}

TEST(BacklashOfALaboratory, IsNamedWhenTheGuideTakesItsFrictionFromTheMotor) {
  const Diagnosis found = diagnosed({.motor_friction_v = 0.08, .guide_friction_v = kFriction_v - 0.08});
  ASSERT_NO_FATAL_FAILURE(expect_cause(found, "backlash", kGap_m, 0.15 * kGap_m));
  EXPECT_NEAR(found.causes[0].parameters.at(2).value, kCarriageShare, 0.1);
  EXPECT_GT(found.causes[0].parameters.at(3).value, 0.8);
}

TEST(LongBacklashOfALaboratory, IsNamedWhenTheGuideHasAdditionalFriction) {
  const Diagnosis found = diagnosed({.guide_friction_v = 0.07});
  ASSERT_NO_FATAL_FAILURE(expect_cause(found, "backlash", kGap_m, 0.15 * kGap_m));
  EXPECT_LT(found.causes[0].parameters.at(3).value, 0.2);
}

}  // namespace
}  // namespace crane::diagnosis
