// Counter wraps, positions and rates.
#include "crane/bridge/measurement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace crane::bridge {
namespace {

std::int32_t as_24_bit(std::int64_t counts) {
  const auto low = static_cast<std::int32_t>(counts & 0xFFFFFF);
  return low >= 0x800000 ? low - 0x1000000 : low;
}

TEST(CountUnwrapper, ContinuesA24BitCounterThroughAnyNumberOfWraps) {
  constexpr unsigned kUnwrapSeed = 24;
  std::mt19937 random{kUnwrapSeed};
  std::uniform_int_distribution<std::int64_t> step{-8'000'000, 8'000'000};
  CountUnwrapper unwrapper;
  std::int64_t truth = 1234;
  EXPECT_EQ(unwrapper.step(as_24_bit(truth)), truth);
  for (int i = 0; i < 10'000; ++i) {
    truth += step(random);
    ASSERT_EQ(unwrapper.step(as_24_bit(truth)), truth) << "seed " << kUnwrapSeed << ", step " << i;
  }
}

TEST(Coordinate, StartsWithoutATransient) {
  Coordinate coordinate{{.channel = 0, .counts_per_unit = 1000, .sign = 1}, 0.01, 0.05};
  for (int i = 0; i < 50; ++i) {
    coordinate.step(700);
    ASSERT_DOUBLE_EQ(coordinate.position(), 0.7);
    ASSERT_NEAR(coordinate.rate(), 0, 1e-9);
  }
}

TEST(Coordinate, ShowsZeroAtTheRestAngleOfItsEncoder) {
  for (const int sign : {1, -1}) {
    Coordinate coordinate{
        {.channel = 0, .counts_per_unit = 1000, .sign = sign, .rest_angle_rad = 0.025}, 0.01, 0.05};
    coordinate.step(sign * 25);
    EXPECT_NEAR(coordinate.position(), 0, 1e-12) << sign;
    EXPECT_NEAR(coordinate.rate(), 0, 1e-9) << "the filters start at rest";
    coordinate.step(sign * 125);
    EXPECT_NEAR(coordinate.position(), 0.1, 1e-12) << sign;
  }
}

TEST(Coordinate, GivesTheSlopeOfARampWithTheSignOfItsWiring) {
  for (const int sign : {1, -1}) {
    Coordinate coordinate{{.channel = 0, .counts_per_unit = 1e5, .sign = sign}, 0.01, 0.05};
    for (int i = 0; i < 400; ++i) coordinate.step(200 * i);  // 0.2 per second
    EXPECT_NEAR(coordinate.rate(), sign * 0.2, 1e-6);
  }
}

TEST(Coordinate, GivesTheSlopeOfARampWithLateAndSkippedTicks) {
  constexpr double kPeriod_s = 0.01, kSpeed = 1, kCounts = 1e5;
  Coordinate coordinate{{.channel = 0, .counts_per_unit = kCounts, .sign = 1}, kPeriod_s, 0.05};
  int before = -1;
  for (int tick = 0; tick < 400; ++tick) {
    if (tick % 30 >= 28) continue;  // two ticks are skipped
    const Latched latched{.ticks = static_cast<std::uint64_t>(tick - before),
                          .late_s = tick % 7 == 3 ? 0.5 * kPeriod_s : 0};
    const double time_s = tick * kPeriod_s + latched.late_s;
    coordinate.step(static_cast<std::int32_t>(std::lround(kSpeed * time_s * kCounts)), latched);
    before = tick;
    if (tick > 200) {
      ASSERT_NEAR(coordinate.rate(), kSpeed, 0.01) << "tick " << tick;
    }
  }
}

TEST(Coordinate, PublishesTheFilteredPositionIfConfigured) {
  // A second-order Butterworth filter with a cut-off of 5 Hz delays a slow ramp by sqrt(2) / (2 pi 5 Hz) = 45
  // ms.
  Coordinate bare{{.channel = 0, .counts_per_unit = 1e5, .sign = 1}, 0.01, 0.05};
  Coordinate filtered{{.channel = 0, .counts_per_unit = 1e5, .sign = 1}, 0.01, 0.05, true};
  for (int i = 0; i < 400; ++i) {
    bare.step(200 * i);
    filtered.step(200 * i);
  }
  EXPECT_DOUBLE_EQ(bare.position(), 399 * 0.002);
  EXPECT_NEAR((bare.position() - filtered.position()) / 0.2, std::sqrt(2) / (2 * M_PI * 5), 1e-3);
  EXPECT_DOUBLE_EQ(filtered.rate(), bare.rate());
}

}  // namespace
}  // namespace crane::bridge
