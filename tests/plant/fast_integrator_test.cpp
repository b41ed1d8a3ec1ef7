/// The fast method against CVODE, on rigs with brakes, end stops and every term.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "closed_loop.hpp"
#include "crane/simulator/simulated_board.hpp"
#include "every_effect.hpp"

namespace crane::simulator::fast_test {
namespace {

using plant::TermSetting;

constexpr std::int64_t kStep_ns = 10'000'000;
constexpr int kTicks = 400;  // 4 s

SimulatedRig tower() {
  SimulatedRig rig;
  rig.drives[plant::kTrolley].low_stop = 0.1;
  rig.drives[plant::kTrolley].high_stop = 0.6;  // the trolley reaches this stop
  rig.drives[plant::kHoist].low_stop = 0.3;
  rig.start.radial_rad = 0.05;
  return rig;
}

/// The numbers of deploy/rigs/gantry.toml.
SimulatedRig gantry() {
  SimulatedRig rig = tower();
  rig.parameters = {.trolley_inertia_kg = 12,
                    .trolley_mass_kg = 4,
                    .load_mass_kg = 3,
                    .trolley_gain_mps2pv = 1.2,
                    .hoist_gain_mpspv = 0.04,
                    .hoist_lag_s = 0.15};
  rig.drives[plant::kSlew].present = false;
  rig.tangential_swing = false;
  return rig;
}

std::vector<plant::State> motion_of(SimulatedRig rig, const std::vector<TermSetting>& terms, Method method,
                                    const Tolerances& tolerances = {}) {
  rig.terms = terms;
  rig.integrator = method;
  SimulatedBoard board{rig, 0, tolerances};
  bridge::Outputs outputs;
  std::vector<plant::State> motion;
  for (int tick = 0; tick < kTicks; ++tick) {
    board.advance_to(tick * kStep_ns);
    motion.push_back(board.truth());
    const double t = 0.01 * tick;
    const bool driven = std::fmod(t, 3) < 2, released = std::fmod(t, 4) < 3;  // standstill; brakes
    outputs.drive_v = {2.5 * std::cos(2.1 * t) * driven, 2 * std::cos(1.7 * t) * driven, 0.5 * std::sin(t)};
    outputs.brake_release = {released, released, released};
    outputs.watchdog_level = !outputs.watchdog_level;
    board.write(outputs);
  }
  return motion;
}

double largest_difference(const std::vector<plant::State>& a, const std::vector<plant::State>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto x = plant::to_array(a[i]), y = plant::to_array(b[i]);
    for (std::size_t k = 0; k < x.size(); ++k) largest = std::max(largest, std::abs(x[k] - y[k]));
  }
  return largest;
}

constexpr Tolerances kTight{.relative = 1e-10, .absolute = 1e-11};
/// In these motions CVODE has errors of up to 5e-4 m, rad, m/s or rad/s, because an error of the time of an
/// impact causes a position error: the time error times the jump of the speed.
constexpr double kErrorOfCvode = 5e-4;

bool fits(const TermSetting& term, const SimulatedRig& rig) {
  return term.axis != "slew" || rig.drives[plant::kSlew].present;
}

void expect_agreement(const SimulatedRig& rig, const std::vector<TermSetting>& terms) {
  const auto exact = motion_of(rig, terms, Method::cvode, kTight);
  EXPECT_GT(std::abs(exact[100].trolley_m - exact[0].trolley_m), 0.05) << "it does not move";
  EXPECT_LT(largest_difference(motion_of(rig, terms, Method::fast), exact), kErrorOfCvode);
}

/// With the friction of the rig, which makes the equations stiff at standstill.
void expect_agreement_with_each_term(const SimulatedRig& rig) {
  for (const TermSetting& term : test::every_effect()) {
    if (!fits(term, rig)) continue;
    SCOPED_TRACE(term.name + " " + term.axis);
    std::vector<TermSetting> terms{term};
    for (const TermSetting& other : test::rig_friction())
      if (fits(other, rig)) terms.push_back(other);
    expect_agreement(rig, terms);
  }
}

TEST(FastIntegrator, AgreesWithCvodeForEachTermOnTheTower) { expect_agreement_with_each_term(tower()); }
TEST(FastIntegrator, AgreesWithCvodeWithoutTerms) {
  expect_agreement(tower(), {});
  expect_agreement(gantry(), {});
}
TEST(FastIntegrator, AgreesWithCvodeForEachTermOnTheGantry) { expect_agreement_with_each_term(gantry()); }

/// Random commands around the break-away voltage, with which the drives stick, creep and slip in turn.
std::vector<plant::State> stick_and_slip(std::uint64_t seed, Method method,
                                         const Tolerances& tolerances = {}) {
  SimulatedRig rig;
  rig.drives[plant::kTrolley].low_stop = -10;
  rig.drives[plant::kTrolley].high_stop = 10;
  rig.terms = test::rig_friction();
  rig.integrator = method;
  SimulatedBoard board{rig, 0, tolerances};
  std::mt19937_64 random{seed};
  std::uniform_real_distribution<double> volts{-2, 2};
  std::uniform_int_distribution<int> held_ticks{1, 40};
  bridge::Outputs outputs;
  outputs.brake_release = {true, true, true};
  std::vector<plant::State> motion;
  for (int tick = 0, next = 0; tick < 1000; ++tick) {
    board.advance_to(tick * kStep_ns);
    motion.push_back(board.truth());
    if (tick == next) {
      outputs.drive_v = {volts(random), volts(random), 0};
      next += held_ticks(random);
    }
    outputs.watchdog_level = !outputs.watchdog_level;
    board.write(outputs);
  }
  return motion;
}

TEST(FastIntegrator, AgreesWithCvodeWhileDrivesStickAndSlip) {
  int closer = 0;
  constexpr int kRuns = 40;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const auto seeded = static_cast<std::uint64_t>(seed);
    const auto exact = stick_and_slip(seeded, Method::cvode, kTight);
    const double error = largest_difference(stick_and_slip(seeded, Method::fast), exact);
    EXPECT_LT(error, kErrorOfCvode) << "seed " << seed;
    closer += error < largest_difference(stick_and_slip(seeded, Method::cvode), exact);
  }
  EXPECT_GT(closer, 0.9 * kRuns) << "runs in which the fast method is closer to the exact motion than CVODE";
}

/// Time of an impact in a motion that has a closed form.
TEST(FastIntegrator, FindsTheImpactAndTheStandstillOfABrakedAxis) {
  for (const Method method : {Method::cvode, Method::fast}) {
    plant::Parameters bare;
    bare.load_mass_kg = 0;
    const plant::Model model{bare};
    Integrator integrator{model, {}, method};
    // x = 2 t^2 / 2 with 1 V: 0.25 m after 0.5 s, with 1 m/s
    plant::State s;
    Watch stop;
    stop.high[plant::kTrolley] = 0.25;
    const Advance impact = integrator.advance(s, test::driven({1, 0, 0}), 2, stop);
    ASSERT_TRUE(impact.event);
    EXPECT_NEAR(impact.elapsed_s, 0.5, 1e-6);
    EXPECT_NEAR(s.trolley_mps, 1, 1e-5);
    // from 1 m/s with 5 m/s2
    plant::Actuation braked;
    braked.brake_effort[plant::kTrolley] = -5 * bare.trolley_inertia_kg;
    Watch rest;
    rest.standstill[plant::kTrolley] = true;
    const Advance standstill = integrator.advance(s, braked, 2, rest);
    ASSERT_TRUE(standstill.event);
    EXPECT_EQ(standstill.event->kind, EventKind::standstill);
    EXPECT_NEAR(standstill.elapsed_s, s.trolley_mps / 5 + 0.2, 1e-5);
    EXPECT_NEAR(s.trolley_mps, 0, 1e-6);
  }
}

TEST(FastIntegrator, TakesTheFirstOfTwoEventsInOneStep) {
  plant::Parameters bare;
  bare.load_mass_kg = 0;
  const plant::Model model{bare};
  Integrator integrator{model, {}, Method::fast};
  plant::State s{.trolley_mps = 1, .slew_radps = 1};
  Watch watch;
  watch.high[plant::kTrolley] = 0.006;
  watch.high[plant::kSlew] = 0.004;
  const Advance first = integrator.advance(s, {}, 0.01, watch);
  ASSERT_TRUE(first.event);
  EXPECT_EQ(first.event->axis, plant::kSlew);
  EXPECT_NEAR(first.elapsed_s, 0.004, 1e-6);
  EXPECT_NEAR(s.trolley_m, 0.004, 1e-6);
}

}  // namespace
}  // namespace crane::simulator::fast_test
