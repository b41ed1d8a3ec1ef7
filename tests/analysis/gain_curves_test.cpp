#include "crane/analysis/gain_curves.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crane::analysis {
namespace {

using std::numbers::pi;
using std::numbers::sqrt2;

/// The source computes its numbers with g = 9.8.
plant::Parameters with_its_gravity(plant::Parameters crane) {
  crane.gravity_mps2 = 9.8;
  return crane;
}

TEST(GainCurves, OverTheCableLengthHaveTheNumbersOfTheDissertation) {
  // (4.18): K L = 3.8, K_x' / sqrt(L) = 1.33, K_phi / L = 3.9122 - 1.28925 m_t with K_m = 2.
  auto crane = with_its_gravity({});
  crane.load_mass_kg = 0;
  for (const auto& point : gains_over_cable_length(crane, 10)) {
    const double length_m = point.abscissa;
    EXPECT_NEAR(point.gains.position * length_m, 3.8007, 5e-5);
    EXPECT_NEAR(point.gains.speed / std::sqrt(length_m), 1.3301, 5e-5);
    EXPECT_NEAR(point.gains.swing / length_m, 3.91220, 5e-6);
    EXPECT_EQ(point.gains.swing_rate, 0);
  }
}

TEST(GainCurves, OverTheMassRatioChangeTheSwingGainOnly) {
  const auto curve = gains_over_mass_ratio(with_its_gravity(figure_parameters(0)), 1, 13);
  for (const auto& point : curve) {
    EXPECT_EQ(point.gains.position, curve.front().gains.position);
    EXPECT_EQ(point.gains.speed, curve.front().gains.speed);
    EXPECT_NEAR(point.gains.swing, 3.91220 - 1.28925 * point.abscissa, 2e-5);
  }
}

TEST(GainCurves, OfTheSlewAxisFollowTheTrolleyPosition) {
  // K = 6.668 + 1.800 x^2, K_theta = 3.9122/x - 1.28925 m_r x / (1 + M_r x^2), with m_r = 2/7.2 and M_r
  // = 1.97/7.2.
  const auto crane = with_its_gravity({});
  for (const auto& point : gains_over_trolley_position(crane, 1, 15)) {
    const double x = point.abscissa, ratio = 1.97 / 7.2;
    EXPECT_NEAR(point.gains.position, 6.668 * (1 + ratio * x * x), 2e-3);
    EXPECT_NEAR(point.gains.swing, 3.9122 / x - 1.28925 * 2 / 7.2 * x / (1 + ratio * x * x), 5e-4 / x);
  }
}

/// Largest distance of a wanted pole to its nearest pole.
double worst_pole(const GainSample& point, double gravity_mps2, double length_m) {
  const double w0 = std::sqrt(gravity_mps2 / length_m), a = 2 / pi * w0;
  const double w = 1.383413 * w0;
  double worst = 0;
  for (const Complex wanted :
       {Complex(-a, 0), Complex(-w / sqrt2, w / sqrt2), Complex(-w / sqrt2, -w / sqrt2)}) {
    double nearest = 1e9;
    for (const Complex& pole : point.poles) nearest = std::min(nearest, std::abs(pole - wanted));
    worst = std::max(worst, nearest);
  }
  return worst;
}

TEST(GainCurves, PlaceThePolesOfTheDesign) {
  // -a is a double pole: rounding of 1e-15 splits it by about 1e-7.
  const auto crane = figure_parameters(0.5);
  for (const auto& point : gains_over_cable_length(crane, 10))
    EXPECT_LT(worst_pole(point, crane.gravity_mps2, point.abscissa), 1e-5);
  for (const auto& point : gains_over_mass_ratio(crane, 1, 10))
    EXPECT_LT(worst_pole(point, crane.gravity_mps2, 1), 1e-5);
  for (const auto& point : gains_over_trolley_position(crane, 1, 10))
    EXPECT_LT(worst_pole(point, crane.gravity_mps2, 1), 1e-5);
}

TEST(ClosedLoopPoles, OfFullFeedbackAreThoseOf320) {
  const control::SwingAxis axis{9.8, 1, 2, 0.09};
  const auto poles = closed_loop_poles(axis, control::full_state_gains(axis, 4));
  const double a = 2 / pi * std::sqrt(9.8), w = pi / 2 * std::sqrt(8.0);
  Complex sum = 0, inverse = 1;
  for (const Complex& pole : poles) sum += pole, inverse *= pole;
  EXPECT_NEAR(sum.real(), -2 * a - sqrt2 * w, 1e-9);
  EXPECT_NEAR(inverse.real(), a * a * w * w, 1e-9);
}

}  // namespace
}  // namespace crane::analysis
