/// Rules for every registered controller (docs/adding_a_law.md).
#include "crane/control/law.hpp"
#include "crane/control/adaptation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>
#include <set>

#include "crane/control/gain_scheduling.hpp"
#include "crane/control/reference_start.hpp"
#include "crane/control/shaper.hpp"
#include "crane/control/trajectory.hpp"

namespace {
std::atomic<long> allocations{0};
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace crane::control {
namespace {

Measurement random_measurement(std::mt19937& random, auto number) {
  Measurement m;
  for (auto& value : m.position) value = number(random);
  for (auto& value : m.speed) value = number(random);
  m.swing_radial_rad = number(random), m.swing_radial_radps = number(random);
  m.swing_tangential_rad = number(random), m.swing_tangential_radps = number(random);
  return m;
}

Reference random_reference(std::mt19937& random, auto number) {
  Reference r;
  for (auto& axis : r) axis = {number(random), number(random), number(random), number(random)};
  return r;
}

/// Zero, and the smallest, ordinary and largest numbers of both signs.
double extreme(std::mt19937& random) {
  using Limits = std::numeric_limits<double>;
  static constexpr std::array kSizes{
      0.0, Limits::denorm_min(), Limits::min(), 1e-9, 1e-3, 0.1, 1.0, 10.0, 1e6, 1e150, Limits::max()};
  const double size = kSizes[std::uniform_int_distribution<std::size_t>(0, kSizes.size() - 1)(random)];
  return std::bernoulli_distribution(0.5)(random) ? size : -size;
}

bool finite(const Contribution& c) {
  for (const double v : c.drive_v)
    if (!std::isfinite(v)) return false;
  for (const auto& axis : c.correction)
    if (!std::isfinite(axis.position) || !std::isfinite(axis.speed) || !std::isfinite(axis.acceleration))
      return false;
  return true;
}

TEST(Registry, FindsEveryControllerByItsOwnNameAndNoOther) {
  std::set<std::string_view> names;
  for (const auto& controller : controllers()) {
    EXPECT_EQ(find_controller(controller.name), &controller);
    EXPECT_TRUE(names.insert(controller.name).second) << controller.name;
    EXPECT_FALSE(controller.summary.empty());
  }
  for (const char* name : {"gain_scheduling_partial", "gain_scheduling_full", "anti_swing_pd", "delayed_1",
                           "delayed_2", "fuzzy_printed", "fuzzy_generated", "anti_swing_pd_optimised",
                           "delayed_1_optimised", "delayed_2_optimised", "none"})
    EXPECT_TRUE(names.contains(name)) << name;
  EXPECT_EQ(find_controller("delayed"), nullptr);
  EXPECT_EQ(find_controller(""), nullptr);
}

TEST(EveryController, DeclaresWhetherItsAntiSwingLawCorrectsTheReference) {
  const unsigned seed = 12;
  std::mt19937 random(seed);
  const auto moderate = [](std::mt19937& draw) {
    return std::uniform_real_distribution<double>(0.1, 0.9)(draw);
  };
  for (const auto& controller : controllers()) {
    const auto law = controller.make_anti_swing(Design{});
    law->reset(random_measurement(random, moderate));
    bool corrects = false;
    for (int k = 0; k < 200; ++k)
      for (const AxisReference& axis : law->step(random_measurement(random, moderate), {}).correction)
        corrects = corrects || axis.position != 0 || axis.speed != 0 || axis.acceleration != 0;
    EXPECT_EQ(controller.corrects_reference, corrects) << controller.name << ", seed " << seed;
  }
}

TEST(EveryLaw, StaysFiniteForAnyFiniteInput) {
  const unsigned seed = 4711;
  std::mt19937 random(seed);
  for (const auto& controller : controllers())
    for (auto* make : {controller.make_tracking, controller.make_anti_swing}) {
      const auto law = make(Design{});
      for (int k = 0; k < 20000; ++k) {
        const auto m = random_measurement(random, extreme);
        if (k % 1000 == 0) law->reset(m);
        ASSERT_TRUE(finite(law->step(m, random_reference(random, extreme))))
            << controller.name << " seed " << seed << " step " << k;
      }
    }
}

/// A design without problems; every number is at or near an end of its range.
Design extreme_design(std::mt19937& random) {
  const auto pick = [&random](std::initializer_list<double> values) {
    return values.begin()[std::uniform_int_distribution<std::size_t>(0, values.size() - 1)(random)];
  };
  Design design;
  design.period_s = pick({0.01, 0.1});
  design.shortest_cable_length_m = pick({1e-3, 0.5});
  design.cable_length_m = design.longest_cable_length_m = pick({0.5, 1000});
  design.full_state_forward_gain_vpm = pick({1e-6, 4, 1000});
  design.tracking_proportional = pick({1e-6, 1e5});
  design.tracking_derivative = pick({0, 1e5});
  design.minimum_trolley_position_m = pick({1e-3, 100});
  design.anti_swing_proportional = design.delayed_1_gain = pick({-1e5, 0, 1e5});
  design.delayed_1_delay = design.delayed_2_delay = pick({0, 2});
  design.delayed_2_gain = pick({-1e3, 1e3});
  design.fuzzy_swing_rad = pick({1e-6, 3.2});
  design.fuzzy_swing_rate = pick({1e-6, 1e3});
  design.fuzzy_gain = pick({-1e5, 1e-9, 1e5});
  design.fuzzy_point_a = pick({0.01, 0.5});
  design.fuzzy_point_b = pick({0.51, 0.99});
  design.volt_limit_v.fill(pick({1e-3, 10}));
  design.crane.gravity_mps2 = pick({1e-3, 100});
  design.crane.load_mass_kg = pick({0, 1e6});
  design.crane.trolley_inertia_kg = pick({1e-6, 1e6});
  design.crane.jib_inertia_kgm2 = pick({1e-6, 1e8});
  design.crane.hoist_gain_mpspv = pick({1e-6, 1000});
  design.crane.trolley_gain_mps2pv = design.crane.slew_gain_radps2pv = pick({1e-6, 1000});
  return design;
}

TEST(EveryLaw, StaysFiniteForAnyDesignWithoutProblems) {
  const unsigned seed = 1789;
  std::mt19937 random(seed);
  for (int trial = 0; trial < 60; ++trial) {
    const Design design = extreme_design(random);
    ASSERT_TRUE(problems(design).empty()) << problems(design).front();
    for (const auto& controller : controllers())
      for (auto* make : {controller.make_tracking, controller.make_anti_swing}) {
        if (make == controller.make_anti_swing && controller.name == "fuzzy_generated" && trial > 0) continue;
        const auto law = make(design);
        for (int k = 0; k < 100; ++k) {
          const auto m = random_measurement(random, extreme);
          if (k % 50 == 0) law->reset(m);
          ASSERT_TRUE(finite(law->step(m, random_reference(random, extreme))))
              << controller.name << " seed " << seed << " trial " << trial << " step " << k;
        }
      }
  }
}

TEST(EveryLaw, RecoversByResetFromInputThatIsNotFinite) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto broken = [](std::mt19937& /*random*/) { return std::numeric_limits<double>::quiet_NaN(); };
  for (const auto& controller : controllers())
    for (auto* make : {controller.make_tracking, controller.make_anti_swing}) {
      const auto law = make(Design{});
      for (int k = 0; k < 100; ++k)
        (void)law->step(random_measurement(random, broken), random_reference(random, broken));
      const auto m = random_measurement(random, number);
      law->reset(m);
      EXPECT_TRUE(finite(law->step(m, random_reference(random, number)))) << controller.name;
    }
}

TEST(EveryLaw, NeverAllocatesInAStep) {
  std::mt19937 random(1);
  for (const auto& controller : controllers())
    for (auto* make : {controller.make_tracking, controller.make_anti_swing}) {
      const auto law = make(Design{});
      const auto m = random_measurement(random, extreme);
      const auto r = random_reference(random, extreme);
      law->reset(m);
      const long before = allocations;
      for (int k = 0; k < 1000; ++k) (void)law->step(m, r);
      law->reset(m);
      EXPECT_EQ(allocations - before, 0) << controller.name;
    }
}

TEST(References, NeverAllocate) {
  const auto profile = limited_profile(0, 1, {0.5, 1, 10});
  const Shaper shaper(Shaping::ei, 2);
  Design design;
  ReferenceStart start;
  double sum = 0;
  const long before = allocations;
  for (int k = 0; k < 1000; ++k) {
    Reference reference;
    reference[kTrolley] = shaper.at(profile, 0.005 * k);
    start.set_starts({}, reference);
    sum += reference[kTrolley].position + forward_gains(design, reference).trolley;
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(sum, 0);
}

TEST(EveryLaw, GivesTheSameOutputForTheSameInputAfterReset) {
  for (const auto& controller : controllers())
    for (auto* make : {controller.make_tracking, controller.make_anti_swing}) {
      const auto law = make(Design{});
      std::array<Volts, 300> first{};
      for (int run = 0; run < 2; ++run) {
        std::mt19937 random(5);
        std::uniform_real_distribution<double> number(-1, 1);
        law->reset(random_measurement(random, number));
        for (auto& volts : first) {
          const auto now = law->step(random_measurement(random, number), {}).drive_v;
          if (run == 0) volts = now;
          EXPECT_EQ(now, volts) << controller.name;
        }
      }
    }
}

TEST(EveryLaw, GivesZeroVoltsAtRestOnItsReference) {
  Measurement m;
  m.position = {0.7, 0.3, 1.2};
  Reference r;
  for (std::size_t axis = 0; axis < kAxes; ++axis) r[axis].position = m.position[axis];
  for (const auto& controller : controllers())
    for (auto* make : {controller.make_tracking, controller.make_anti_swing}) {
      const auto law = make(Design{});
      law->reset(m);
      for (const double v : law->step(m, r).drive_v) EXPECT_EQ(v, 0) << controller.name;
    }
}

TEST(Adaptation, AllocatesNothingInItsSteps) {
  Design design;
  design.friction.fill({1.5, 6.0, 0.9, 1.2, 0.9, 1.2, 100, 0.005, 1});
  design.adaptation.enabled = true;
  Adaptation adaptation{design};
  AdaptationInput input;
  input.consecutive = true;
  input.measured.position = {0.7, 0.3, 1.2};
  const long before = allocations;
  for (int k = 0; k < 2000; ++k) {
    input.measured.position[kTrolley] = 0.7 + 0.3 * std::sin(0.02 * k);
    input.measured.swing_radial_rad = 0.05 * std::sin(0.03 * k);
    adaptation.step(input);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(adaptation.report().axis[kTrolley].direction[0].blocks, 0U);
}

}  // namespace
}  // namespace crane::control
