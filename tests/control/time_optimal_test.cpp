/// Compares time-optimal plans with the equations of the plant, the least times of docs/comparison.md, and a
/// crane with friction, encoders and delay. Duration about 3 s.
#include "crane/control/time_optimal.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "planned_crane.hpp"
#include "time_optimal/tower.hpp"

namespace crane::control {
namespace {

/// Least times from rest to rest with |V| <= 10 V and swing <= 10 deg, without friction: an independent
/// sequential linear programme (docs/comparison.md).
constexpr std::array kBounds_s{1.531, 1.767, 1.728};
constexpr double kPlanning_s = 0.05;

PlanProblem problem_of(const TestMove& move, double volts) {
  PlanProblem problem;
  problem.from = {move.from_m, 0};
  problem.to = {move.to_m, move.to_rad};
  problem.limits = {
      .volts = {volts, volts}, .low = {0.19, -2.74}, .high = {1.31, 2.74}, .speed = {1.35, 3.15}};
  return problem;
}

/// Random design, state and volts in the whole range of the planner.
struct RandomCase {
  Design design;
  double cable_m;
  PlanState state;
  PlanVolts volts;

  explicit RandomCase(std::mt19937& random) {
    const auto between = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    auto& p = design.crane;
    p.load_mass_kg = between(0.1, 10), p.trolley_inertia_kg = between(5, 40);
    p.trolley_mass_kg = between(0.5, 5), p.jib_inertia_kgm2 = between(2, 20);
    p.rotating_share = between(0, 1), p.centrifugal_share = between(0, 1);
    design.friction = tower_with_friction().design.friction;
    cable_m = between(0.3, 1.5);
    state << between(0.2, 1.3), between(-1, 1), between(-3, 3), between(-1, 1), between(-1.3, 1.3),
        between(-3, 3), between(-3, 3), between(-3, 3);
    volts << between(-10, 10), between(-10, 10);
  }
};

PlanState rate_of(const RandomCase& at) {
  time_optimal::Flow flow;
  time_optimal::flow({at.design, at.cable_m}, at.state, at.volts, false, flow);
  return flow.rate;
}

TEST(TimeOptimalTower, AcceleratesAsThePlantDoes) {
  std::mt19937 random(1);
  for (int i = 0; i < 10'000; ++i) {
    const RandomCase at(random);
    const auto& s = at.state;
    const plant::State state{s[0], s[1], s[2], s[3], at.cable_m, s[4], s[5], s[6], s[7], 0};
    const auto& p = at.design.crane;
    const auto driving_v = [&](plant::Axis axis, double volts, double speed) {
      return volts - time_optimal::smooth_friction(at.design.friction[axis], speed).volts;
    };
    const auto wanted = plant::accelerations(
        p, state,
        {.trolley_n = p.trolley_inertia_kg * p.trolley_gain_mps2pv * driving_v(kTrolley, at.volts[0], s[4]),
         .slew_nm = p.jib_inertia_kgm2 * p.slew_gain_radps2pv * driving_v(kSlew, at.volts[1], s[6])},
        0);
    PlanState rate;
    rate << s.tail<4>(), wanted.trolley_mps2, wanted.radial_radps2, wanted.slew_radps2,
        wanted.tangential_radps2;
    // The plant eliminates the swing, the planner inverts the mass matrix: the results differ by rounding.
    constexpr double kRounding = 1e-10;
    EXPECT_LT((rate_of(at) - rate).norm(), kRounding * (1 + rate.norm())) << "case " << i;
  }
}

TEST(TimeOptimalTower, HasTheDerivativesOfItsAccelerations) {
  std::mt19937 random(2);
  for (int i = 0; i < 1'000; ++i) {
    const RandomCase at(random);
    time_optimal::Flow flow;
    time_optimal::flow({at.design, at.cable_m}, at.state, at.volts, true, flow);
    constexpr double kStep = 1e-5, kTruncation = 1e-5;  // central difference: error of the order of kStep^2
    for (int column = 0; column < kPlanStates + 2; ++column) {
      const auto moved = [&](double by) {
        RandomCase to = at;
        (column < kPlanStates ? to.state[column] : to.volts[column - kPlanStates]) += by;
        return rate_of(to);
      };
      const PlanState slope = (moved(kStep) - moved(-kStep)) / (2 * kStep);
      const PlanState exact = column < kPlanStates ? PlanState{flow.by_state.col(column)}
                                                   : PlanState{flow.by_control.col(column - kPlanStates)};
      EXPECT_LT((exact - slope).norm(), kTruncation * (1 + exact.norm())) << "case " << i << ", " << column;
    }
  }
}

TEST(TimeOptimalPlan, TakesNearlyTheLeastTimeWithoutFriction) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto result =
        std::make_unique<PlanResult>(time_optimal_plan(Design{}, problem_of(kTestMoves[i], 10)));
    ASSERT_EQ(result->outcome, PlanOutcome::solved) << "maneuver " << i + 1;
    EXPECT_LT(result->plan.duration_s, 1.02 * kBounds_s[i]) << "maneuver " << i + 1;
  }
}

TEST(TimeOptimalPlan, BringsTheNonlinearCraneToRestAtTheTargetWithinItsLimits) {
  TestCrane crane;  // no friction
  for (const TestMove& move : kTestMoves) {
    const PlanProblem problem = problem_of(move, 10);
    const auto result = std::make_unique<PlanResult>(time_optimal_plan(crane.design, problem));
    ASSERT_EQ(result->outcome, PlanOutcome::solved);
    plant::State s;
    s.trolley_m = move.from_m;
    const double interval_s = result->plan.duration_s / kPlanIntervals;
    crane.design.period_s = interval_s;  // after_tick() holds the volts for one interval
    for (const PlanVolts& volts : result->plan.volts) {
      ASSERT_LE(volts.cwiseAbs().maxCoeff(), 10);
      s = after_tick(crane, s, {volts[0], volts[1], 0});
      EXPECT_LT(std::abs(s.radial_rad), 10.05 * std::numbers::pi / 180);
      EXPECT_LT(std::abs(s.tangential_rad), 10.05 * std::numbers::pi / 180);
    }
    EXPECT_NEAR(s.trolley_m, move.to_m, 1e-3);
    EXPECT_NEAR(s.slew_rad, move.to_rad, 1e-3);
    EXPECT_NEAR(s.radial_rad, 0, 1e-3);
    EXPECT_NEAR(s.tangential_rad, 0, 1e-3);
    EXPECT_NEAR(s.trolley_mps, 0, 3e-3);
    EXPECT_NEAR(s.slew_radps, 0, 3e-3);
  }
}

TEST(TimeOptimalPlan, IsTheSameForTheSameMove) {
  const PlanProblem problem = problem_of(kTestMoves[2], 9.5);
  const auto first = std::make_unique<PlanResult>(time_optimal_plan(Design{}, problem));
  const auto second = std::make_unique<PlanResult>(time_optimal_plan(Design{}, problem));
  EXPECT_EQ(first->plan.duration_s, second->plan.duration_s);
  for (std::size_t k = 0; k < kPlanIntervals; ++k) EXPECT_EQ(first->plan.volts[k], second->plan.volts[k]);
}

TEST(TimeOptimalPlan, NamesTheReasonOfAnImpossibleMove) {
  PlanProblem problem = problem_of(kTestMoves[0], 10);
  problem.to[kTrolley] = 5;
  problem.limits.swing_rad = 0;
  const auto found = problems(problem);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NE(found[0].find("trolley target"), std::string::npos) << found[0];
  EXPECT_NE(found[1].find("swing"), std::string::npos) << found[1];
  EXPECT_EQ(time_optimal_plan(Design{}, problem).outcome, PlanOutcome::impossible);
}

TestResult planned_move(const TestCrane& crane, std::size_t i) {
  const PlanProblem problem = problem_of(kTestMoves[i], 9.5);
  const auto result = std::make_unique<PlanResult>(time_optimal_plan(crane.design, problem));
  EXPECT_EQ(result->outcome, PlanOutcome::solved);
  const auto at = run_move(crane, *find_controller("time_optimal"), kTestMoves[i], [&](double time_s) {
    return reference_at(crane.design, problem, result->plan, time_s - kPlanning_s);
  });
  return at;
}

TEST(TimeOptimalController, SettlesNearTheBoundWithFrictionEncodersAndDelay) {
  for (std::size_t i = 0; i < 3; ++i) {
    const TestResult at = planned_move(tower_with_friction(), i);
    // In maneuver 2 the swing at the end of the plan is 0.6 deg; it decays below 0.5 deg within 0.5 s.
    constexpr std::array kRatio{1.05, 1.4, 1.05};
    EXPECT_LT(at.settled_s, kRatio[i] * kBounds_s[i]) << "maneuver " << i + 1;
    EXPECT_LT(at.residual_rad, 0.3 * std::numbers::pi / 180) << "maneuver " << i + 1;  // stick and slip
  }
}

TEST(TimeOptimalController, EndsAtRestWithAWrongCableLengthOrLoad) {
  for (int wrong = 0; wrong < 4; ++wrong)
    for (std::size_t i = 0; i < 3; ++i) {
      TestCrane crane = tower_with_friction();
      if (wrong < 2) crane.cable_ratio = wrong == 0 ? 0.8 : 1.2;
      if (wrong == 2 || wrong == 3) crane.truth.load_mass_kg *= wrong == 2 ? 0.5 : 1.5;
      EXPECT_LT(planned_move(crane, i).residual_rad, 0.5 * std::numbers::pi / 180)
          << wrong << " maneuver " << i + 1;
    }
}

TEST(Lqr, SettlesTheManeuversOnTheFrictionPlant) {
  for (std::size_t i = 0; i < 3; ++i) {
    const TestMove& move = kTestMoves[i];
    Reference target;
    target[kTrolley].position = move.to_m, target[kSlew].position = move.to_rad, target[kHoist].position = 1;
    for (const bool observes : {false, true}) {
      TestCrane crane = tower_with_friction();
      crane.design.swing_observer = observes;
      const auto at = run_move(crane, *find_controller("lqr"), move, [&](double) { return target; });
      EXPECT_LT(at.settled_s, 6.5) << "maneuver " << i + 1 << (observes ? ", observer" : "");
      EXPECT_LT(at.residual_rad, 0.5 * std::numbers::pi / 180) << "maneuver " << i + 1;
    }
  }
}

}  // namespace
}  // namespace crane::control
