/// Compares every linear anti-swing law with its characteristic equation in normalised time,
///   (s^2 + 4 pi^2)(s^2 + K_d s + K_p) - s^2 G(s) = 0,
/// tower sign, exact delays, no Pade approximation.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <string>

#include "linear_model.hpp"

namespace crane::control {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

struct Loop {
  const char* controller;
  Complex (*feedback)(Complex);  ///< G(s)
  double dominant_damping;       ///< of the right-most pair
  double least_damping;          ///< of all pairs below kHighest
  Complex least_damped;          ///< known root

  [[nodiscard]] Complex characteristic(Complex s) const {
    return (s * s + 4 * pi * pi) * (s * s + 20.0 * s + 100.0) - s * s * feedback(s);
  }
};

/// A delay causes infinitely many roots, whose damping ratio tends to zero. "Least damping" therefore refers
/// to the roots below eight load frequencies.
constexpr double kHighest = 50;

const Loop kLoops[] = {
    {"anti_swing_pd", [](Complex s) { return -30.0 + 8.0 * s; }, 0.432, 0.331, {-3.13, 8.92}},
    {"delayed_1", [](Complex s) { return -90.0 * std::exp(-0.1 * s); }, 0.399, 0.233, {-2.48, 10.33}},
    {"delayed_2",
     [](Complex s) { return -0.33 * (100.0 + 20.0 * s) * std::exp(-0.31 * s); },
     0.061,
     0.061,
     {-0.517, 8.458}},
    // The optima of the first two laws are double roots; gains rounded to four digits split them. The exact
    // values are 0.3963 and 0.3808.
    {"anti_swing_pd_optimised", [](Complex s) { return -25.66 + 7.434 * s; }, 0.393, 0.393, {-3.119, 7.302}},
    {"delayed_1_optimised",
     [](Complex s) { return -49.38 * std::exp(-0.1193 * s); },
     0.376,
     0.376,
     {-2.680, 6.602}},
    {"delayed_2_optimised",
     [](Complex s) { return -0.423 * (100.0 + 20.0 * s) * std::exp(-0.179 * s); },
     0.195,
     0.195,
     {-1.033, 5.189}},
};

/// Newton's method with a central difference.
std::optional<Complex> root_near(const Loop& loop, Complex s) {
  for (int k = 0; k < 60; ++k) {
    const double h = 1e-5 * (1 + std::abs(s));
    const Complex slope = (loop.characteristic(s + h) - loop.characteristic(s - h)) / (2 * h);
    const Complex change = loop.characteristic(s) / slope;
    s -= change;
    if (std::abs(change) < 1e-12 * (1 + std::abs(s))) return s;
  }
  return std::nullopt;
}

TEST(AntiSwingLaws, HaveTheDampingOfTheirExactCharacteristicEquation) {
  for (const Loop& loop : kLoops) {
    double right_most = -1e9, dominant = 1, least = 1;
    for (double re = -20; re <= 5; re += 1)
      for (double im = 0; im <= kHighest; im += 1) {
        const auto root = root_near(loop, {re, im});
        if (!root || root->imag() < 1e-6 || root->imag() > kHighest) continue;
        const double damping = -root->real() / std::abs(*root);
        least = std::min(least, damping);
        if (root->real() > right_most) right_most = root->real(), dominant = damping;
      }
    EXPECT_LT(right_most, 0) << loop.controller;
    EXPECT_NEAR(dominant, loop.dominant_damping, 1e-3) << loop.controller;
    EXPECT_NEAR(least, loop.least_damping, 1e-3) << loop.controller;
  }
}

/// One axis at constant x, (2.28)-(2.31).
double drive_acceleration(const Design& design, Motion motion, double x, double volts, double swing) {
  const auto& c = design.crane;
  const double weight = c.load_mass_kg * c.gravity_mps2 * swing;
  if (motion == Motion::trolley) return c.trolley_gain_mps2pv * volts - weight / c.trolley_inertia_kg;
  return (c.slew_gain_radps2pv * volts + x * weight / c.jib_inertia_kgm2) /
         (1 + c.trolley_mass_kg / c.jib_inertia_kgm2 * x * x);
}

/// Starts the sampled axis on one mode of the characteristic equation, including the history of the delay,
/// and expects that it stays on this mode. Semi-implicit Euler has a first-order error of h |s|^2 t / 2 of
/// the swing, largest near t = 1 / |Re s|.
void expect_mode_is_kept(const Loop& loop, Motion motion, Complex root) {
  Design design;
  design.period_s = 1e-4;
  design.cable_length_m = 1.4;
  const double x = 0.7, swing0 = 0.1, h = design.period_s, g = design.crane.gravity_mps2;
  const double drag = motion == Motion::trolley ? 1 : -x;  // L swing'' + g swing = drag * drive acceleration
  const double period_s = 2 * pi * std::sqrt(design.cable_length_m / g);
  const Complex s = root / period_s;
  const Complex position0 =
      swing0 * (root * root + 4 * pi * pi) / (root * root) * design.cable_length_m / drag;
  const auto on_mode = [&](double t) {
    const Complex now = std::exp(s * t), swing = swing0 * now, position = position0 * now;
    return Eigen::Vector4d(position.real(), (s * position).real(), swing.real(), (s * swing).real());
  };
  const Controller& controller = *find_controller(loop.controller);
  const auto tracking = controller.make_tracking(design), anti_swing = controller.make_anti_swing(design);
  const std::size_t axis = motion == Motion::trolley ? kTrolley : kSlew;
  for (int k = -12000; k < 0; ++k) (void)anti_swing->step(measurement(design, motion, x, on_mode(k * h)), {});
  Eigen::Vector4d state = on_mode(0);
  double worst = 0;
  for (int k = 0; k * h < 2 * period_s; ++k) {
    worst = std::max(worst, std::abs(state(2) - on_mode(k * h)(2)));
    const auto measured = measurement(design, motion, x, state);
    const Contribution swing_part = anti_swing->step(measured, {});
    Reference reference = swing_part.correction;
    reference[kTrolley].position += x;
    const double v = tracking->step(measured, reference).drive_v[axis] + swing_part.drive_v[axis];
    const double acceleration = drive_acceleration(design, motion, x, v, state(2));
    state(1) += h * acceleration;
    state(0) += h * state(1);
    state(3) += h * (drag * acceleration - g * state(2)) / design.cable_length_m;
    state(2) += h * state(3);
  }
  EXPECT_LT(worst, h * std::norm(s) / 2 / std::abs(s.real()) * swing0) << loop.controller;
}

TEST(AntiSwingLaws, MoveTheLinearModelAlongTheRootsOfTheirCharacteristicEquation) {
  for (const Loop& loop : kLoops) {
    const auto root = root_near(loop, loop.least_damped);
    ASSERT_TRUE(root);
    EXPECT_NEAR(std::abs(*root - loop.least_damped), 0, 0.02) << loop.controller << " root " << *root;
    expect_mode_is_kept(loop, Motion::trolley, *root);
  }
}

TEST(AntiSwingLaws, TreatTheSlewAxisLikeTheTrolleyAtConstantTrolleyPosition) {
  // The slew schedule reads x itself, which the trolley keeps constant here.
  for (const Loop& loop : kLoops)
    expect_mode_is_kept(loop, Motion::slew, *root_near(loop, loop.least_damped));
}

}  // namespace
}  // namespace crane::control
