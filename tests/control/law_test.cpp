/// What every registered controller promises.
#include "crane/control/law.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>
#include <set>

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
  for (auto& axis : r) axis = {number(random), number(random), number(random)};
  return r;
}

/// Zero, the smallest, ordinary and the largest numbers of either sign.
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

TEST(EveryLaw, OutlivesInputThatIsNotANumberAndRecoversByReset) {
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

TEST(EveryLaw, AsksForNothingAtRestOnItsReference) {
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

}  // namespace
}  // namespace crane::control
