#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "crane/plant/model.hpp"

namespace crane::plant {
namespace {

constexpr double kPeriod_s = 0.01;
constexpr State kSomewhere{
    .trolley_m = 0.5, .radial_rad = 0.03, .slew_rad = -1, .tangential_rad = 0.04, .cable_m = 1.2};

Model sensing(const TermSetting& term) { return Model{{}, {term}, kPeriod_s}; }

/// Sensor values of the radial swing for given true swings, one per tick.
template <class Signal>
std::vector<double> radial_reports(const TermSetting& term, Signal signal, int ticks) {
  Model model = sensing(term);
  std::vector<double> reports;
  reports.reserve(static_cast<std::size_t>(ticks));
  for (int i = 0; i < ticks; ++i) reports.push_back(model.measure({.radial_rad = signal(i)}).radial_rad);
  return reports;
}

TEST(SwingOffset, IsAddedToItsAngle) {
  const Measurement m = sensing({"swing_offset", "tangential", {{"offset_rad", 0.01}}}).measure(kSomewhere);
  EXPECT_EQ(m.radial_rad, 0.03);
  EXPECT_NEAR(m.tangential_rad, 0.05, 1e-15);
}

TEST(SwingScale, MultipliesItsAngle) {
  const Measurement m = sensing({"swing_scale", "radial", {{"factor", 1.1}}}).measure(kSomewhere);
  EXPECT_NEAR(m.radial_rad, 0.033, 1e-15);
  EXPECT_EQ(m.tangential_rad, 0.04);
}

TEST(SwingMisalignment, TurnsTheSwingWithoutChangingItsSize) {
  const Measurement m = sensing({"swing_misalignment", "", {{"angle_rad", 0.2}}}).measure(kSomewhere);
  EXPECT_NEAR(std::hypot(m.radial_rad, m.tangential_rad), 0.05, 1e-15);
  EXPECT_NEAR(std::atan2(0.04, 0.03) - std::atan2(m.tangential_rad, m.radial_rad), 0.2, 1e-12);
}

TEST(PositionScale, MultipliesItsPosition) {
  const Measurement m = sensing({"position_scale", "slew", {{"factor", 0.9}}}).measure(kSomewhere);
  EXPECT_NEAR(m.slew_rad, -0.9, 1e-15);
  EXPECT_EQ(m.trolley_m, 0.5);
}

TEST(PositionDrift, GrowsWithTheDistanceTravelledEitherWay) {
  Model model = sensing({"position_drift", "trolley", {{"rate", 0.01}}});
  EXPECT_EQ(model.measure({.trolley_m = 0.5}).trolley_m, 0.5);
  for (const double at : {0.7, 0.9, 0.6}) (void)model.measure({.trolley_m = at});
  EXPECT_NEAR(model.measure({.trolley_m = 0.5}).trolley_m, 0.5 + 0.01 * 0.8, 1e-15);
}

TEST(PositionDrift, ComesInJumpsWhereCountsAreLost) {
  Model model = sensing({"position_drift", "slew", {{"rate", -0.01}, {"jump", 0.002}}});
  const auto lost = [&](double at) { return model.measure({.slew_rad = at}).slew_rad - at; };
  EXPECT_EQ(lost(0), 0);
  EXPECT_NEAR(lost(0.19), 0, 1e-15);
  EXPECT_NEAR(lost(0.21), -0.002, 1e-15);
  EXPECT_NEAR(lost(0), -0.004, 1e-15);
}

TEST(SwingDelay, ReportsTheDelayedSampleOrTheFirstSample) {
  const auto ramp = [](int i) { return 0.001 * (i + 5); };
  const auto whole = radial_reports({"swing_delay", "radial", {{"delay_s", 0.03}}}, ramp, 40);
  EXPECT_EQ(whole[2], ramp(0));
  EXPECT_NEAR(whole[20], ramp(17), 1e-15);
  const auto part = radial_reports({"swing_delay", "", {{"delay_s", 0.025}}}, ramp, 40);
  EXPECT_NEAR(part[20], 0.5 * (ramp(17) + ramp(18)), 1e-15);
}

/// Mean of a sine over w: the amplitude is multiplied by sin(omega w/2) / (omega w/2), the delay is w/2. The
/// linear interpolation between samples has an error of (omega T)^2 / 12 = 3e-4 of the amplitude.
TEST(SwingMovingAverage, OfASineIsSmallerAndHalfAWindowLate) {
  constexpr double kOmega = 6;
  for (const double window_s : {0.05, 0.123, 0.4}) {
    const auto sine = [](double ticks) { return std::sin(kOmega * kPeriod_s * ticks); };
    const auto reports = radial_reports({"swing_moving_average", "", {{"window_s", window_s}}}, sine, 200);
    const double half = 0.5 * kOmega * window_s;
    for (int i = 60; i < 200; ++i) {
      EXPECT_NEAR(reports[static_cast<std::size_t>(i)],
                  std::sin(half) / half * std::sin(kOmega * kPeriod_s * i - half), 4e-4);
    }
  }
}

TEST(SwingMovingAverage, IsContinuousInItsWindow) {
  const auto wild = [](int i) { return i % 3 == 0 ? 0.1 : -0.05 * i; };
  for (const double window_s : {1e-12, 0.01, 0.03}) {
    const auto less =
        radial_reports({"swing_moving_average", "", {{"window_s", window_s * (1 - 1e-9)}}}, wild, 20);
    const auto more =
        radial_reports({"swing_moving_average", "", {{"window_s", window_s * (1 + 1e-9)}}}, wild, 20);
    EXPECT_NEAR(less.back(), more.back(), 1e-7) << window_s;
    if (window_s == 1e-12) {
      EXPECT_NEAR(less.back(), wild(19), 1e-7);
    }
  }
}

}  // namespace
}  // namespace crane::plant
