#include <gtest/gtest.h>

#include <numbers>

#include "closed_loop.hpp"
#include "crane/plant/matrices.hpp"
#include "crane/plant/model.hpp"
#include "lagrange_oracle.hpp"

/// Slopes, responses and the period of the equations of motion.
namespace crane::plant {
namespace {

/// Slope of the accelerations of a model with respect to one entry of the state, at the hanging load.
Eigen::Matrix4d numeric_matrix(const Model& model, const State& at, const std::array<std::size_t, 4>& rows) {
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  a(0, 2) = a(1, 3) = 1;
  for (int j = 0; j < 4; ++j) {
    StateArray up = to_array(at), down = up;
    constexpr double kStep = 1e-5;
    up[rows[static_cast<std::size_t>(j)]] += kStep;
    down[rows[static_cast<std::size_t>(j)]] -= kStep;
    const auto high = test::values(model.accelerations(to_state(up), {}));
    const auto low = test::values(model.accelerations(to_state(down), {}));
    for (int i = 0; i < 2; ++i) {
      const std::size_t row = rows[static_cast<std::size_t>(i)];
      a(2 + i, j) = (high[row] - low[row]) / (2 * kStep);
    }
  }
  return a;
}

TEST(Equations, LinearisedMatricesAreTheSlopesOfTheModelAtTheHangingLoad) {
  const Parameters p;
  const Model model{p};
  const State at{.trolley_m = 0.7, .cable_m = 0.9};
  constexpr double kDifferencing = 1e-8;  // of central differences with a step of 1e-5
  const LinearModel translation = linear_translation(p, at.cable_m);
  const LinearModel rotation = linear_rotation(p, at.trolley_m, at.cable_m);
  EXPECT_LT((numeric_matrix(model, at, {0, 1, 5, 6}) - translation.a).cwiseAbs().maxCoeff(), kDifferencing);
  EXPECT_LT((numeric_matrix(model, at, {2, 3, 7, 8}) - rotation.a).cwiseAbs().maxCoeff(), kDifferencing);
  const Accelerations driven = model.accelerations(at, test::driven({1, 1, 0}));
  EXPECT_NEAR(driven.trolley_mps2, translation.b[2], 1e-12);
  EXPECT_NEAR(driven.radial_radps2, translation.b[3], 1e-12);
  EXPECT_NEAR(driven.slew_radps2, rotation.b[2], 1e-12);
  EXPECT_NEAR(driven.tangential_radps2, rotation.b[3], 1e-12);
}

TEST(Equations, TheDrivesRespondToForcesAsTheInverseOfTheMassMatrixSays) {
  std::mt19937 random{test::kSeed};
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE("seed " + std::to_string(test::kSeed) + " case " + std::to_string(i));
    const Parameters p = test::random_crane(random);
    const State s = test::random_state(random);
    const Eigen::Matrix4d inverse = mass_matrix(p, s).inverse();
    const DriveResponse free = drive_response(p, s);
    EXPECT_NEAR(free.trolley_mps2_pn, inverse(0, 0), 1e-9 * inverse(0, 0));
    EXPECT_NEAR(free.slew_radps2_pnm, inverse(2, 2), 1e-9 * inverse(2, 2));
    EXPECT_NEAR(free.coupling, inverse(0, 2), 1e-9 * (inverse(0, 0) + inverse(2, 2)));
    const DriveResponse held = drive_response(p, s, {.axis = {false, true, true}});
    EXPECT_EQ(held.slew_radps2_pnm, 0);
    EXPECT_EQ(held.coupling, 0);
    EXPECT_LT(held.trolley_mps2_pn, free.trolley_mps2_pn);
  }
}

TEST(Equations, AVoltOfFrictionHasTheEffectOfTheFrictionResponse) {
  std::mt19937 random{test::kSeed};
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE("seed " + std::to_string(test::kSeed) + " case " + std::to_string(i));
    const Model model{test::random_crane(random)};
    const State s = test::random_state(random);
    const auto taken = model.friction_response(s, {}, {});
    for (const Axis axis : {kTrolley, kSlew}) {
      PerAxis friction_v{};
      friction_v[axis] = 1;
      InnerAccelerations ignored{};
      const Accelerations without = model.accelerations(s, {}, PerAxis{}, {}, ignored);
      const Accelerations with = model.accelerations(s, {}, friction_v, {}, ignored);
      const double scale = 1e-9 * (1 + std::abs(without.trolley_mps2) + std::abs(without.slew_radps2));
      EXPECT_NEAR(taken[kTrolley][axis], without.trolley_mps2 - with.trolley_mps2, scale);
      EXPECT_NEAR(taken[kSlew][axis], without.slew_radps2 - with.slew_radps2, scale);
    }
  }
}

/// Time between two passages of phi through zero in the same direction.
double period_s(double amplitude_rad, double cable_m) {
  const Model model{Parameters{}};
  Actuation held;
  held.locks = {.axis = {true, true, true}, .radial = false, .tangential = true};
  State s{.trolley_m = 1, .radial_rad = amplitude_rad, .cable_m = cable_m};
  constexpr double kStep = 1e-3;
  double first = 0;
  for (int i = 0, passages = 0;; ++i) {
    const State next = test::runge_kutta_step(model, s, held, kStep);
    if (s.radial_rad < 0 && next.radial_rad >= 0) {
      const double t = kStep * (i - s.radial_rad / (next.radial_rad - s.radial_rad));
      if (passages++ == 1) return t - first;
      first = t;
    }
    s = next;
  }
}

TEST(Equations, FreePendulumHasTheExactPeriodOfItsAmplitude) {
  const double small = 2 * std::numbers::pi * std::sqrt(1 / 9.81);
  EXPECT_NEAR(period_s(0.001, 1), small, 1e-6);
  double a = 1, g = std::cos(0.5);  // T = T_0 / agm(1, cos(amplitude / 2)), amplitude 1 rad
  for (int i = 0; i < 6; ++i) {
    const double mean = (a + g) / 2;
    g = std::sqrt(a * g);
    a = mean;
  }
  EXPECT_NEAR(period_s(1, 1), small / a, 1e-6);
}

}  // namespace
}  // namespace crane::plant
