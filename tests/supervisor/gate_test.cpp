#include "crane/supervisor/gate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "timeline.hpp"

namespace crane::supervisor {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Steps the gate and stores its output as the voltage that reached the drives.
GateOutput pass(const Limits& limits, GateMemory& memory, double trolley_v, bool arrived = true,
                bool drives_active = true) {
  const GateOutput out = gate(
      limits, {.arrived = arrived, .demand_v = {trolley_v, 0, 0}, .drives_active = drives_active}, memory);
  memory.last_v = out.drive_v;
  return out;
}

TEST(Gate, PassesAnOrdinaryDemandUnchanged) {
  GateMemory memory;
  for (const double v : {0.0, 3.25, -6.5, -9.75, 0.125, 10.0}) {
    const GateOutput out = pass(test_limits(), memory, v);
    EXPECT_EQ(out.drive_v[0], v);
    EXPECT_FALSE(out.clamped);
    EXPECT_EQ(out.cause, Cause::none);
  }
}

TEST(Gate, SaturatesDemandsOfALawWithoutEverStopping) {
  GateMemory memory;
  for (const double v : {12.8, 65.0, 100.0, 10.0 * kRejectionRatio}) {
    for (int i = 0; i < 1000; ++i) {
      const GateOutput out = pass(test_limits(), memory, v);
      ASSERT_EQ(out.drive_v[0], 10);
      ASSERT_TRUE(out.clamped);
      ASSERT_EQ(out.cause, Cause::none);
    }
  }
  EXPECT_EQ(memory.clamped_count, 4000U);
}

TEST(Gate, RejectsDemandsAbove20TimesTheLimitAndStopsAtTheThird) {
  for (const double v : {10.0 * kRejectionRatio * 1.01, 1e300, -1e300, std::numeric_limits<double>::max()}) {
    GateMemory memory;
    pass(test_limits(), memory, 2);
    for (int i = 0; i < 3; ++i) {
      const GateOutput out = pass(test_limits(), memory, v);
      EXPECT_TRUE(out.invalid) << v;
      EXPECT_LE(out.drive_v[0], 2) << v;
      EXPECT_EQ(out.cause, i < 2 ? Cause::none : Cause::demand_invalid) << v;
    }
  }
}

TEST(Gate, RejectsAWholeDemandWithOneValueThatIsNotFinite) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      GateMemory memory{.last_v = {1, 2, 0}};
      GateInput input{.arrived = true, .demand_v = {5, 5, 5}, .drives_active = true};
      input.demand_v[axis] = bad;
      const GateOutput out = gate(test_limits(), input, memory);
      EXPECT_TRUE(out.invalid);
      EXPECT_EQ(out.drive_v, (PerAxis{1, 2, 0}));
      EXPECT_EQ(memory.rejected_count, 1U);
    }
  }
}

TEST(Gate, MissingAndInvalidDemandsTogetherEndTheHeldOutput) {
  GateMemory memory;
  EXPECT_EQ(pass(test_limits(), memory, 5).cause, Cause::none);
  EXPECT_EQ(pass(test_limits(), memory, kNaN).cause, Cause::none);
  EXPECT_EQ(pass(test_limits(), memory, 0, false).cause, Cause::none);
  EXPECT_EQ(pass(test_limits(), memory, kNaN).cause, Cause::demand_invalid);
  EXPECT_EQ(memory.missing_count, 1U);
}

TEST(Gate, AFullStepFromRestIsNotClampedAndAReversalTakesTwoTicks) {
  GateMemory memory;
  EXPECT_FALSE(pass(test_limits(), memory, 10).clamped);
  const GateOutput half = pass(test_limits(), memory, -10);
  EXPECT_TRUE(half.clamped);
  EXPECT_EQ(half.drive_v[0], 0);
  EXPECT_EQ(pass(test_limits(), memory, -10).drive_v[0], -10);
}

TEST(Gate, UninterruptedRateLimitingStopsTheCrane) {
  for (const double rate_vps : {1000.0, 100.0}) {
    Limits limits = test_limits();
    limits.axis[0].volt_rate_limit_vps = rate_vps;
    GateMemory memory;
    int ticks = 0;
    while (ticks < 1000 && pass(limits, memory, ticks % 2 == 0 ? 10 : -10).cause == Cause::none) ++ticks;
    EXPECT_GE(memory.rate_pressure, rate_pressure_limit(limits)) << rate_vps;
    EXPECT_LT(ticks, 100) << rate_vps;
  }
}

TEST(Gate, PassesAFullReversalWithALowRateLimit) {
  Limits limits = test_limits();
  limits.axis[0].volt_rate_limit_vps = 100;  // 1 V per tick
  GateMemory memory;
  for (int i = 0; i < 30; ++i) ASSERT_EQ(pass(limits, memory, 10).cause, Cause::none);
  for (int i = 0; i < 30; ++i) ASSERT_EQ(pass(limits, memory, -10).cause, Cause::none);
  EXPECT_EQ(memory.last_v[0], -10);
}

TEST(Gate, GivesNoVoltageWhileNotArmedOrOnAbsentAxes) {
  GateMemory memory;
  EXPECT_EQ(pass(test_limits(), memory, 5, true, false).drive_v, PerAxis{});
  EXPECT_EQ(
      gate(test_limits(), {.arrived = true, .demand_v = {5, 5, 5}, .drives_active = true}, memory).drive_v[2],
      0);
}

TEST(Gate, BlocksTheDirectionOfALimitOnly) {
  GateMemory memory{.last_v = {4, 0, 0}};
  const GateInput outward{
      .arrived = true, .demand_v = {5, -5, 0}, .drives_active = true, .block_positive = {true, true}};
  EXPECT_EQ(gate(test_limits(), outward, memory).drive_v, (PerAxis{0, -5, 0}));
  const GateInput held{.arrived = false, .drives_active = true, .block_positive = {true}};
  EXPECT_EQ(gate(test_limits(), held, memory).drive_v[0], 0);
}

// Compares the gate with an independent formula for range and rate: the median of demand and both bounds.
TEST(Gate, AgreesWithTheMedianOfDemandAndBounds) {
  constexpr unsigned kSeed = 7;
  std::mt19937_64 random{kSeed};
  std::uniform_real_distribution<double> volts{-15, 15};
  Limits limits = test_limits();
  limits.axis[0] = {
      .present = true, .volt_limit_v = 6, .volt_rate_limit_vps = 250, .low_limit = 0, .high_limit = 1};
  GateMemory memory;
  for (int i = 0; i < 100000; ++i) {
    const double demand = volts(random);
    const double high = std::fmin(6.0, memory.last_v[0] + 2.5);
    const double low = std::fmax(-6.0, memory.last_v[0] - 2.5);
    const double expected = std::fmax(std::fmin(low, high), std::fmin(std::fmax(low, high), demand));
    ASSERT_NEAR(pass(limits, memory, demand).drive_v[0], expected, 1e-12)
        << "seed " << kSeed << " step " << i;
  }
}

}  // namespace
}  // namespace crane::supervisor
