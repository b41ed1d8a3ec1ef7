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

TEST(CountUnwrapper, BeginsAtTheValueNearestToTheStart) {
  CountUnwrapper unwrapper{18'015'748};  // 28.6 m of 629,921 counts per m
  EXPECT_EQ(unwrapper.step(as_24_bit(18'015'750)), 18'015'750);
  EXPECT_EQ(unwrapper.step(as_24_bit(18'015'000)), 18'015'000);
}

/// The oracle computes the counts of an ideal counter of any width.
TEST(MeasurementPipeline, MeasuresTheStartForAnyScaleSignAndStart) {
  constexpr unsigned kStartSeed = 28;
  std::mt19937 random{kStartSeed};
  std::uniform_real_distribution<double> exponent{2, 9}, start{-200, 200}, rest{-0.1, 0.1};
  std::bernoulli_distribution negative;
  for (int trial = 0; trial < 10'000; ++trial) {
    configuration::Rig rig;
    std::array<double, kCounters> truth{};
    std::array<std::int32_t, kCounters> raw{};
    for (std::size_t i = 0; i < kCounters; ++i) {
      auto& encoder = rig.encoders[i];
      encoder.counts_per_unit = std::pow(10, exponent(random));
      encoder.sign = negative(random) ? -1 : 1;
      if (i >= kDrives) encoder.rest_angle_rad = rest(random);
      truth[i] = start(random);
      const auto counts =
          std::llround(encoder.sign * (truth[i] + encoder.rest_angle_rad) * encoder.counts_per_unit);
      raw[i] = as_24_bit(counts);
    }
    std::copy_n(truth.begin(), kDrives, rig.start.position.begin());
    rig.start.swing_radial_rad = truth[3];
    rig.start.swing_tangential_rad = truth[4];
    MeasurementPipeline pipeline{rig};
    (void)pipeline.step(raw);
    for (std::size_t i = 0; i < kCounters; ++i)
      ASSERT_NEAR(pipeline.coordinates()[i].position(), truth[i],
                  0.51 / rig.encoders[i].counts_per_unit + 1e-12)
          << "seed " << kStartSeed << ", trial " << trial << ", coordinate " << i;
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
