#include "crane/control/zero_phase.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

namespace crane::control {
namespace {

using std::numbers::pi;

/// Gain and phase of the middle of a long filtered sine, by correlation over whole periods.
std::complex<double> middle_response(double ratio, double cutoff_ratio, int order) {
  const auto period = static_cast<std::size_t>(std::lround(1 / ratio));
  const std::size_t size = 4000, first = 1600, last = first + 800 / period * period;
  std::vector<double> sine(size);
  for (std::size_t k = 0; k < size; ++k)
    sine[k] = std::sin(2 * pi * static_cast<double>(k) / static_cast<double>(period));
  const auto filtered = zero_phase_butterworth(sine, cutoff_ratio, order);
  std::complex<double> sum = 0;
  for (std::size_t k = first; k < last; ++k)
    sum += filtered[k] * std::polar(1.0, -2 * pi * static_cast<double>(k) / static_cast<double>(period));
  return sum * std::complex<double>(0, 2.0 / static_cast<double>(last - first));
}

TEST(ZeroPhase, HasTheSquaredButterworthGainAndNoPhase) {
  for (const int order : {1, 2, 3, 5, 8})
    for (const double cutoff_ratio : {0.02, 0.05, 0.1})
      for (const int period : {160, 50, 20, 10, 5}) {
        const double ratio = 1.0 / period;
        const double warped = std::tan(pi * ratio) / std::tan(pi * cutoff_ratio);
        const double gain = 1 / (1 + std::pow(warped, 2 * order));
        const auto measured = middle_response(ratio, cutoff_ratio, order);
        // Only rounding errors, because the ends are far away.
        EXPECT_NEAR(measured.real(), gain, 1e-9) << order << " " << cutoff_ratio << " " << ratio;
        EXPECT_NEAR(measured.imag(), 0, 1e-9) << order << " " << cutoff_ratio << " " << ratio;
      }
}

TEST(ZeroPhase, HalvesTheCutOffFrequencyAndPassesLowFrequencies) {
  EXPECT_NEAR(middle_response(0.05, 0.05, 5).real(), 0.5, 1e-9);
  EXPECT_NEAR(middle_response(0.0125, 0.05, 5).real(), 1, 1e-5);
  EXPECT_NEAR(middle_response(0.2, 0.05, 5).real(), 0, 1e-6);
}

TEST(ZeroPhase, PassesConstantsAndStraightLinesUpToTheEnds) {
  std::vector<double> line(300), constant(300, -4.2);
  for (std::size_t k = 0; k < line.size(); ++k) line[k] = 7 - 0.3 * static_cast<double>(k);
  const auto smooth_line = zero_phase_butterworth(line, 0.05);
  const auto smooth_constant = zero_phase_butterworth(constant, 0.05);
  for (std::size_t k = 0; k < line.size(); ++k) {
    EXPECT_NEAR(smooth_line[k], line[k], 1e-5) << k;  // the transient of the start has decayed to exp(-12)
    EXPECT_NEAR(smooth_constant[k], -4.2, 1e-12) << k;
  }
}

TEST(ZeroPhase, IsTheSameBackwardsInTime) {
  const unsigned seed = 11;
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  std::vector<double> series(2000);
  for (auto& value : series) value = noise(random);
  auto reversed = series;
  std::reverse(reversed.begin(), reversed.end());
  const auto one = zero_phase_butterworth(series, 0.05);
  auto other = zero_phase_butterworth(reversed, 0.05);
  std::reverse(other.begin(), other.end());
  // Compared far from the ends, where the order of the passes has no effect.
  for (std::size_t k = 500; k < 1500; ++k) EXPECT_NEAR(one[k], other[k], 1e-9) << "seed " << seed << " " << k;
}

TEST(ZeroPhase, TakesSeriesOfAnyLength) {
  EXPECT_TRUE(zero_phase_butterworth({}, 0.05).empty());
  for (std::size_t size = 1; size < 40; ++size) {
    std::vector<double> line(size);
    for (std::size_t k = 0; k < size; ++k) line[k] = static_cast<double>(k) - 3;
    const auto filtered = zero_phase_butterworth(line, 0.3);
    ASSERT_EQ(filtered.size(), size);
    for (const double value : filtered) EXPECT_TRUE(std::isfinite(value)) << size;
  }
  EXPECT_EQ(zero_phase_butterworth(std::vector{2.5}, 0.05), std::vector{2.5});
}

TEST(ZeroPhase, RefusesInvalidParametersByName) {
  const std::vector<double> samples(10);
  for (const double ratio : {0.0, -0.1, 0.5, 1e-5, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW((void)zero_phase_butterworth(samples, ratio), std::invalid_argument) << ratio;
  try {
    (void)zero_phase_butterworth(samples, 0.7, 0);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "cutoff_ratio = 0.7: must be in [0.0001, 0.5); order = 0: must be in [1, 12]");
  }
}

TEST(ButterworthSections, OfOrderTwoAreTheFilterOfTheLoop) {
  for (const double ratio : {0.01, 0.05, 0.2, 0.4}) {
    const auto sections = butterworth_sections(ratio, 2);
    const auto loop = butterworth_low_pass(ratio);
    ASSERT_EQ(sections.size(), 1U);
    EXPECT_NEAR(sections[0].b0, loop.b0, 1e-15);
    EXPECT_NEAR(sections[0].a1, loop.a1, 1e-15);
    EXPECT_NEAR(sections[0].a2, loop.a2, 1e-15);
  }
}

}  // namespace
}  // namespace crane::control
