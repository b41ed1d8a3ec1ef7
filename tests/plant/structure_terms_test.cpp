#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "lagrange_oracle.hpp"
#include "structure_motion.hpp"

namespace crane::plant {
namespace {

using test::held;
using test::StructureMotion;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kStep_s = 0.001;

/// Mean time between two upward crossings of zero.
template <class Signal>
double period_s(const Model& model, StructureMotion motion, double seconds, Signal signal) {
  double first = -1, last = 0, before = signal(motion);
  int periods = -1;
  for (int i = 1; i * kStep_s < seconds; ++i) {
    motion = test::step(model, motion, held(), kStep_s);
    const double now = signal(motion);
    if (before < 0 && now >= 0) {
      last = (i - now / (now - before)) * kStep_s;
      if (first < 0) first = last;
      ++periods;
    }
    before = now;
  }
  return (last - first) / periods;
}

TEST(CableTension, IsTheForceThatLagrangesEquationForTheLengthAsksFor) {
  std::mt19937 random{test::kSeed};
  for (unsigned i = 0; i < 200; ++i) {
    const Parameters p = test::random_inclined_crane(random, i / 2);
    const State s = test::random_state(random);
    const Accelerations a = accelerations(p, s, test::random_forces(random), i % 2 == 0 ? 0 : 0.7);
    EXPECT_NEAR(cable_tension(p, s).tension_n(a), -test::required_forces(p, s, a)[4], 1e-9);
  }
}

TEST(CableLength, IsSeenByTheMotionAndNotByTheSensor) {
  std::mt19937 random{test::kSeed};
  Model longer{{}, {{"cable_length", "", {{"delta_m", 0.2}}}}};
  const Model plain{Parameters{}};
  const State s = test::random_state(random);
  State true_state = s;
  true_state.cable_m += 0.2;
  EXPECT_EQ(test::values(longer.accelerations(s, held())),
            test::values(plain.accelerations(true_state, held())));
  EXPECT_EQ(longer.measure(s).cable_m, s.cable_m);
}

TEST(JibFlexibility, RingsWithTheFrequencyAndDampingOfItsParameters) {
  constexpr double kFrequency_hz = 2, kDamping = 0.05;
  const double compliance = 1 / std::pow(kTurn * kFrequency_hz, 2);
  const Model model{{},
                    {{"jib_flexibility", "", {{"compliance_s2", compliance}, {"damping_ratio", kDamping}}}}};
  const StructureMotion bent{{.trolley_m = 1}, {{{0.01, 0}}}};
  const double damped_hz = kFrequency_hz * std::sqrt(1 - kDamping * kDamping);
  EXPECT_NEAR(1 / period_s(model, bent, 4, [](const auto& m) { return m.inner[0].position; }), damped_hz,
              1e-5);
  StructureMotion motion = bent;
  const int period = static_cast<int>(std::lround(1 / damped_hz / kStep_s));
  for (int i = 0; i < period; ++i) motion = test::step(model, motion, held(), kStep_s);
  const double decrement = kTurn * kDamping / std::sqrt(1 - kDamping * kDamping);
  // the period has an error of up to one step
  EXPECT_NEAR(motion.inner[0].position, 0.01 * std::exp(-decrement), 1e-5);
}

TEST(JibFlexibility, TransmitsTheMotionOfTheRootAfterTheJibHasBent) {
  const Model flexible{{}, {{"jib_flexibility", "", {{"compliance_s2", 0.01}}}}}, rigid{Parameters{}};
  const State rest{.trolley_m = 1};
  EXPECT_NEAR(rigid.accelerations(rest, held({0, 2, 0})).tangential_radps2, -2, 1e-12);  // -x gamma'' / L
  EXPECT_NEAR(flexible.accelerations(rest, held({0, 2, 0})).tangential_radps2, 0, 1e-12);
}

TEST(JibFlexibility, IsRigidAboveTwelveHertz) {
  const auto coordinates = [](double hz) {
    const double compliance = 1 / std::pow(kTurn * hz, 2);
    return Model{{}, {{"jib_flexibility", "", {{"compliance_s2", compliance}}}}}.inner_coordinates();
  };
  EXPECT_EQ(coordinates(12.01), 0U);
  EXPECT_EQ(coordinates(11.99), 1U);
}

TEST(CableElasticity, BouncesWithTheRootOfStiffnessOverMass) {
  const Model model{{}, {{"cable_elasticity", "", {{"compliance_mpn", 0.001}, {"damping_ratio", 0}}}}};
  const double expected_hz = std::sqrt(1 / (0.001 * Parameters{}.load_mass_kg)) / kTurn;
  const StructureMotion stretched{{.trolley_m = 1}, {{{0.01, 0}}}};
  EXPECT_NEAR(1 / period_s(model, stretched, 4, [](const auto& m) { return m.inner[0].position; }),
              expected_hz, 1e-4);
}

TEST(CableElasticity, KeepsTheEnergyOfASpringPendulum) {
  constexpr double kCompliance = 0.002;
  const Parameters p;
  const Model model{p, {{"cable_elasticity", "", {{"compliance_mpn", kCompliance}, {"damping_ratio", 0}}}}};
  const auto energy = [&](const StructureMotion& m) {
    State s = m.state;
    s.cable_m += m.inner[0].position, s.cable_mps += m.inner[0].rate;
    const double stretch = m.inner[0].position + p.load_mass_kg * p.gravity_mps2 * kCompliance;
    return energy_j(p, s) + 0.5 * stretch * stretch / kCompliance;
  };
  StructureMotion motion{{.trolley_m = 1, .radial_rad = 0.6, .tangential_rad = 0.4, .tangential_radps = 1}};
  const double start = energy(motion);
  for (int i = 0; i < 5000; ++i) motion = test::step(model, motion, held(), kStep_s);
  // of 20 J; the expected error, of fourth order in the step, is 1e-6
  EXPECT_NEAR(energy(motion), start, 1e-5);
  EXPECT_GT(std::abs(motion.inner[0].position) + std::abs(motion.inner[0].rate), 1e-3);
}

TEST(DoublePendulum, HasTheTwoFrequenciesOfTheTextbook) {
  constexpr double kShare = 0.4, kUpper_m = 1, kLower_m = 0.3;
  const Parameters p;
  const Model model{p, {{"double_pendulum", "", {{"lower_share", kShare}, {"lower_length_m", kLower_m}}}}};
  const auto response = [&](double upper, double relative) {
    InnerAccelerations own{};
    const Accelerations a = model.accelerations({.trolley_m = 1, .radial_rad = upper, .cable_m = kUpper_m},
                                                held(), {{{relative, 0}}}, own);
    return Eigen::Vector2d{a.radial_radps2, own[0]};
  };
  constexpr double kSmall = 1e-5;
  Eigen::Matrix2d stiffness;
  stiffness << response(kSmall, 0) / -kSmall, response(0, kSmall) / -kSmall;
  Eigen::Vector2d squares = stiffness.eigenvalues().real();
  if (squares[0] > squares[1]) std::swap(squares[0], squares[1]);
  // masses m1, m2, lengths l1, l2: w^2 = g / (2 m1) (b -+ sqrt(b^2 - 4 m1 (m1 + m2) / (l1 l2)))
  const double m1 = (1 - kShare) * p.load_mass_kg, m2 = kShare * p.load_mass_kg;
  const double b = (m1 + m2) * (1 / kUpper_m + 1 / kLower_m);
  const double root = std::sqrt(b * b - 4 * m1 * (m1 + m2) / (kUpper_m * kLower_m));
  EXPECT_NEAR(squares[0], p.gravity_mps2 / (2 * m1) * (b - root), 1e-6);
  EXPECT_NEAR(squares[1], p.gravity_mps2 / (2 * m1) * (b + root), 1e-6);
}

TEST(DoublePendulum, HasItsHookAboveTheEndOfALengthThatReachesToTheLoad) {
  static constexpr double kLower_m = 0.3;
  const auto with = [](double raised_m) {
    return Model{{},
                 {{"double_pendulum",
                   "",
                   {{"lower_share", 0.4}, {"lower_length_m", kLower_m}, {"hook_raised_m", raised_m}}}}};
  };
  const InnerState inner{{{0.02, 0.1}, {-0.03, 0.2}}};
  const auto at = [&](const Model& model, double cable_m) {
    InnerAccelerations own{};
    const Accelerations a =
        model.accelerations({.trolley_m = 0.8, .radial_rad = 0.1, .tangential_rad = -0.2, .cable_m = cable_m},
                            held(), inner, own);
    return Eigen::Vector4d{a.radial_radps2, a.tangential_radps2, own[0], own[1]};
  };
  EXPECT_LT((at(with(kLower_m), 1) - at(with(0), 1 - kLower_m)).norm(), 1e-12);
  EXPECT_GT((at(with(kLower_m), 1) - at(with(0), 1)).norm(), 0.1);
}

TEST(DoublePendulum, KeepsTheMomentumAlongTheJib) {
  constexpr double kShare = 0.4, kLower_m = 0.3;
  const Parameters p;
  const Model model{p, {{"double_pendulum", "", {{"lower_share", kShare}, {"lower_length_m", kLower_m}}}}};
  InnerAccelerations own{};
  const Accelerations a =
      model.accelerations({.trolley_m = 1, .radial_rad = 0.01}, {}, {{{-0.025, 0}, {0, 0}}}, own);
  const double hook = a.trolley_mps2 - a.radial_radps2;  // x'' - L phi'', L = 1
  const double load = hook - kLower_m * (a.radial_radps2 + own[0]);
  const double force =
      p.trolley_inertia_kg * a.trolley_mps2 + p.load_mass_kg * ((1 - kShare) * hook + kShare * load);
  EXPECT_NEAR(force, 0, 1e-4);  // error of third order in the angles
  EXPECT_GT(std::abs(a.trolley_mps2), 1e-3);
}

TEST(DoublePendulum, KeepsItsEnergyInWideSwings) {
  constexpr double kShare = 0.45, kUpper_m = 0.5, kLower_m = 0.3;
  const Parameters p;
  const Model model{p, {{"double_pendulum", "", {{"lower_share", kShare}, {"lower_length_m", kLower_m}}}}};
  const auto unit = [](double phi, double theta) {
    return Eigen::Vector3d{-std::cos(theta) * std::sin(phi), std::sin(theta),
                           -std::cos(theta) * std::cos(phi)};
  };
  const auto energy = [&](const StructureMotion& m) {
    const State& s = m.state;
    const auto& [phi, theta] = std::pair{m.inner[0], m.inner[1]};
    constexpr double kStep = 1e-6;  // s, central difference of the directions
    const auto at = [&](double t, double share_of_lower) {
      return unit(
          s.radial_rad + share_of_lower * phi.position + t * (s.radial_radps + share_of_lower * phi.rate),
          s.tangential_rad + share_of_lower * theta.position +
              t * (s.tangential_radps + share_of_lower * theta.rate));
    };
    const Eigen::Vector3d hook = kUpper_m * at(0, 0), load = hook + kLower_m * at(0, 1);
    const Eigen::Vector3d hook_mps = kUpper_m * (at(kStep, 0) - at(-kStep, 0)) / (2 * kStep);
    const Eigen::Vector3d load_mps = hook_mps + kLower_m * (at(kStep, 1) - at(-kStep, 1)) / (2 * kStep);
    return (1 - kShare) * (hook_mps.squaredNorm() / 2 + p.gravity_mps2 * hook.z()) +
           kShare * (load_mps.squaredNorm() / 2 + p.gravity_mps2 * load.z());
  };
  StructureMotion motion{
      {.radial_rad = 0.9, .tangential_rad = -0.5, .cable_m = kUpper_m, .radial_radps = -0.7},
      {{{-0.4, 2}, {0.6, -1}}}};
  const double start = energy(motion);
  double largest_rad = 0;
  for (int i = 0; i < 5000; ++i) {
    motion = test::step(model, motion, held(), kStep_s);
    largest_rad = std::max(largest_rad, std::abs(motion.inner[0].position));
  }
  EXPECT_NEAR(energy(motion), start, 1e-6);  // J/kg, of 4 J/kg
  EXPECT_GT(largest_rad, 0.5);
}

TEST(DoublePendulum, SwingsTheSameOverGroundWhenTheCraneTurnsAboutIt) {
  const Model model{{}, {{"double_pendulum", "", {{"lower_share", 0.4}, {"lower_length_m", 0.3}}}}};
  constexpr double kTurning = 0.7;
  // the load hangs on the tower axis; relative to the turning crane, it initially moves backwards
  StructureMotion still{{.trolley_m = 0, .radial_rad = 0.01}}, turning = still;
  turning.state.slew_radps = kTurning;
  turning.state.tangential_radps = kTurning * 0.01;
  for (int i = 0; i < 3000; ++i) {
    still = test::step(model, still, held(), kStep_s);
    turning = test::step(model, turning, held(), kStep_s);
  }
  const auto lower_over_ground = [](const StructureMotion& m) {
    const Eigen::Vector2d in_jib{-(m.state.radial_rad + m.inner[0].position),
                                 m.state.tangential_rad + m.inner[1].position};
    return Eigen::Vector2d{Eigen::Rotation2Dd{m.state.slew_rad} * in_jib};
  };
  EXPECT_LT((lower_over_ground(turning) - lower_over_ground(still)).norm(), 1e-5);  // of 0.01 rad
  EXPECT_GT(std::abs(turning.inner[1].position), 1e-4);
}

TEST(DoublePendulum, FollowsTheSwingThatAFlexibleJibLeaves) {
  const std::vector<TermSetting> terms{{"jib_flexibility", "", {{"compliance_s2", 0.01}}},
                                       {"double_pendulum", "", {{"lower_share", 0.4}}}};
  InnerAccelerations own{};
  const Accelerations a = Model{{}, terms}.accelerations({.trolley_m = 1}, held({0, 2, 0}), {}, own);
  EXPECT_NEAR(a.tangential_radps2, 0, 1e-12);  // the root accelerates before the tip
  EXPECT_NEAR(own[2], 0, 1e-12);
}

/// To less than a count of a swing encoder, 2.6e-4 rad; measured 6e-5.
TEST(Structures, FollowDrivesInFixedStepsOf2Point5Milliseconds) {
  const std::vector<TermSetting> stiffest{
      {"jib_flexibility", "", {{"compliance_s2", 1 / std::pow(kTurn * 12, 2) * 1.001}}},
      {"cable_elasticity", "", {{"compliance_mpn", 0.001}}},
      {"double_pendulum", "", {{"lower_share", 0.5}, {"lower_length_m", 0.1}}},
      {"backlash", "trolley", {{"gap", 0.001}, {"guide_deceleration", 2}}},
      {"backlash", "slew", {{"gap", 0.01}}},
  };
  const Model model{{}, stiffest};
  StructureMotion coarse{{.trolley_m = 0.5}}, fine = coarse;
  for (int i = 0; i < 800; ++i) {
    Actuation actuation;
    actuation.drive_v = {3 * std::sin(0.02 * i), 2 * std::cos(0.013 * i), 0};
    coarse = test::step(model, coarse, actuation, 0.0025);
    for (int part = 0; part < 25; ++part) fine = test::step(model, fine, actuation, 0.0001);
  }
  const auto a = to_array(coarse.state), b = to_array(fine.state);
  for (std::size_t i = 0; i < kStateSize; ++i) EXPECT_NEAR(a[i], b[i], 2e-4) << i;
}

}  // namespace
}  // namespace crane::plant
