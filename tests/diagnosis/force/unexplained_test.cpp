/// Unexplained force on a drive; intervals of a fit.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "force/force_lines.hpp"
#include "force/jumps.hpp"
#include "force/unexplained.hpp"
#include "score/sealed_case.hpp"
#include "search/intervals.hpp"
#include "study/own_noise.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kTick_s = 0.01;
constexpr double kViscous_vspm = 0.4;

struct Conditions {
  unsigned latest_step = 0;     ///< largest delay of a row after its tick, in steps of 1/20 tick
  double disturbance_v = 0.02;  ///< rms, correlation time 1 s
  double command_hz = 0;        ///< frequency of the command beside a slow sine; 0: random commands
  bool controlled = false;      ///< a controller follows random targets
};

/// A drive axis with viscous friction under random commands. @param extra_v additional voltage, of time,
/// position and speed
template <class Extra>
PreparedRun moved(const configuration::Rig& rig, double duration_s, unsigned seed, Extra&& extra_v,
                  const Conditions& conditions = {}) {
  constexpr int kSteps = 20;
  std::mt19937 random(seed), late(seed + 100);
  std::normal_distribution<double> normal;
  Run run;
  run.name = "run " + std::to_string(seed);
  run.period_s = kTick_s;
  const double gain = rig.plant.trolley_gain_mps2pv;
  double x = 0, v = 0, u = 0, push = 0, target = 0;
  for (int k = 0; k < duration_s / kTick_s; ++k) {
    if (k % 50 == 0) u = 0.5 * normal(random) - 0.6 * x;
    if (conditions.controlled) {
      if (k % 200 == 0) target = 0.3 * normal(random);
      u = 6 * (target - x) - 3 * v;
    }
    if (conditions.command_hz > 0) {
      const double turn = 2 * std::numbers::pi * kTick_s * k;
      u = 0.5 * std::sin(conditions.command_hz * turn) + 0.3 * std::sin(0.27 * turn);
    }
    push += (-push * kTick_s + conditions.disturbance_v * std::sqrt(2 * kTick_s) * normal(random)) / 1.0;
    run.command_v.push_back({u, 0, 0});
    run.cable_m.push_back(1);
    const double count = 1e-5 * normal(random);
    const int row_at = static_cast<int>(late() % (conditions.latest_step + 1));
    if (conditions.latest_step > 0) run.offset_s.push_back(row_at * kTick_s / kSteps);
    for (int step = 0; step < kSteps; ++step) {
      if (step == row_at) run.measured[kTrolleyPosition].push_back(x + count);
      const double t = kTick_s * (k + static_cast<double>(step) / kSteps);
      const double a = gain * (u + push + extra_v(t, x, v) - kViscous_vspm * v);
      x += kTick_s / kSteps * (v + 0.5 * kTick_s / kSteps * a);
      v += kTick_s / kSteps * a;
    }
  }
  return prepare(std::move(run), rig);
}

configuration::Rig axis_with_viscous_friction() {
  configuration::Rig rig = score::rig_file_of("drive_axis");
  rig.terms = {{"viscous_friction", "trolley", {{"vspm", kViscous_vspm}}}};
  return rig;
}

struct Left {
  std::vector<Unexplained> patterns;
  std::optional<Unexplained> line, jumps;
};

Left left_in(const Runs& runs, const configuration::Rig& rig) {
  const Pieces pieces = pieces_of(runs, replays_of(runs, {rig.plant, rig.terms}), kTrolleyPosition);
  return {find_unexplained(pieces), find_force_line(pieces, 1, rig.plant.trolley_gain_mps2pv),
          find_jumps(pieces)};
}

template <class Extra>
Left left_of(Extra&& extra_v) {
  const configuration::Rig rig = axis_with_viscous_friction();
  return left_in({moved(rig, 30, 1, extra_v), moved(rig, 30, 2, extra_v)}, rig);
}

double nothing(double, double, double) { return 0; }

/// The speed at the start of a piece acts until the measured times of the rows.
TEST(EquationError, OfLateRowsIsAsSmallAsOfRegularRows) {
  const configuration::Rig rig = axis_with_viscous_friction();
  const Runs regular{moved(rig, 30, 1, nothing, {.disturbance_v = 0})},
      late{moved(rig, 30, 1, nothing, {.latest_step = 8, .disturbance_v = 0})};
  const Crane crane{rig.plant, rig.terms};
  const Pieces of_regular = pieces_of(regular, replays_of(regular, crane), kTrolleyPosition);
  const Pieces of_late = pieces_of(late, replays_of(late, crane), kTrolleyPosition, of_regular.disturbance);
  EXPECT_LT(of_late.squares(), 1.2 * of_regular.squares());
  EXPECT_FALSE(find_jumps(of_late));
}

/// The commands of a slow logger may turn the axis around from row to row. Position and speed at the start of
/// a piece explain two rows.
TEST(EquationError, OfAMotionOfFewRowsIsFiniteAndHasPiecesOfAtLeastThreeRows) {
  const configuration::Rig rig = axis_with_viscous_friction();
  diagnosis::Run slow;
  slow.name = "slow logger";
  slow.period_s = 0.1;
  for (int row = 0; row < 300; ++row) {
    const int turning = row % 60 < 40 ? 20 : 1;  // rows in one direction
    const double position = row / turning % 2 == 0 ? row % turning : turning - row % turning;
    slow.measured[kTrolleyPosition].push_back(0.01 * position);
    slow.command_v.push_back({row / turning % 2 == 0 ? 0.2 : -0.2, 0, 0});
    slow.cable_m.push_back(1);
  }
  const Runs runs{prepare(std::move(slow), rig)};
  const Pieces pieces = pieces_of(runs, replays_of(runs, {rig.plant, rig.terms}), kTrolleyPosition);
  ASSERT_FALSE(pieces.all.empty());
  for (const Piece& piece : pieces.all) {
    EXPECT_GE(piece.rows, 3U);
    EXPECT_TRUE(piece.residual.allFinite()) << piece.first;
  }
}

/// With an inversion of first order, an error of 2 mm of 40 cm would remain at a scale of 7 %.
TEST(EquationError, InvertsAScaleOfTheEncoderAndKeepsTheResidualInSensorUnits) {
  constexpr double kScale = 0.93;
  const configuration::Rig rig = axis_with_viscous_friction();
  const Runs as_it_was{moved(rig, 30, 1, nothing)};
  diagnosis::Run shown = as_it_was[0].run;
  for (double& position : shown.measured[kTrolleyPosition]) position *= kScale;
  const Runs scaled{prepare(shown, rig)};
  Crane crane{rig.plant, rig.terms};
  crane.terms.push_back({"position_scale", "trolley", {{"factor", kScale}}});

  const Replays replays = replays_of(scaled, crane);
  const auto increments = replays[0].increments_along_measurement(kTrolleyPosition);
  for (std::size_t k = 0; k < shown.rows(); ++k)
    ASSERT_NEAR(increments.position[k], as_it_was[0].motion[kTrolleyPosition].position[k], 1e-5) << k;
  const Pieces right = pieces_of(as_it_was, replays_of(as_it_was, {rig.plant, rig.terms}), kTrolleyPosition);
  const Pieces undone = pieces_of(scaled, replays, kTrolleyPosition, right.disturbance);
  EXPECT_NEAR(undone.squares() / right.squares(), kScale * kScale, 0.01);
}

TEST(Unexplained, IsEmptyForTheRightModel) {
  const Left left = left_of(nothing);
  for (const Unexplained& u : left.patterns) EXPECT_LT(u.fraction, 0.008) << u.variable;
  EXPECT_FALSE(left.line) << left.line->variable;
  EXPECT_FALSE(left.jumps) << left.jumps->variable;
}

TEST(Unexplained, ForceInOnePlaceIsAForceByPosition) {
  const Left left = left_of([](double, double x, double) {
    const double s = (x - 0.05) / 0.02;
    return -0.5 * s * std::exp(-0.5 * s * s);
  });
  ASSERT_FALSE(left.patterns.empty());
  EXPECT_THAT(left.patterns[0].variable, testing::StartsWith("trolley: position"));
  EXPECT_GT(left.patterns[0].fraction, 0.02);
}

TEST(Unexplained, FrictionInOnePlaceIsFrictionByPosition) {
  const Left left =
      left_of([](double, double x, double v) { return -std::tanh(v / 1e-3) * (x > 0.1 ? 0.1 : 0.0); });
  ASSERT_FALSE(left.patterns.empty());
  EXPECT_EQ(left.patterns[0].variable, "trolley: friction by position");
  EXPECT_GT(left.patterns[0].fraction, 0.02);
}

double over_time(const Left& left) {
  double most = 0;
  for (const Unexplained& u : left.patterns)
    if (u.with == GoesWith::time) most = std::max(most, u.fraction);
  return most;
}

/// A jib whose bearing carries more moment when the trolley is far out. The other axis moves slowly to and
/// fro.
TEST(Unexplained, FrictionByThePositionOfTheOtherAxisIsFound) {
  const configuration::Rig rig = axis_with_viscous_friction();
  const auto other = [](double t) { return std::sin(0.4 * t); };
  const auto friction_v = [&](double t, double, double v) { return -0.1 * other(t) * std::tanh(v / 1e-3); };
  Runs runs;
  for (const unsigned seed : {1U, 2U}) {
    PreparedRun& run = runs.emplace_back(moved(rig, 30, seed, friction_v));
    for (std::size_t row = 0; row < run.run.rows(); ++row)
      run.run.measured[kSlewAngle].push_back(other(static_cast<double>(row) * kTick_s));
    run.motion[kSlewAngle] = spline(run.run.measured[kSlewAngle], kTick_s);
  }
  const Left left = left_in(runs, rig);
  ASSERT_FALSE(left.patterns.empty());
  EXPECT_EQ(left.patterns[0].variable, "trolley: friction by position of the slew");
}

TEST(Unexplained, OnlyFrictionThatGrowsIsAFunctionOfTime) {
  const Left grows = left_of([](double t, double, double v) { return -0.2 * t / 30 * std::tanh(v / 1e-3); });
  const Left stays = left_of([](double, double, double v) { return -0.1 * std::tanh(v / 1e-3); });
  EXPECT_GT(over_time(grows), 0.02);
  EXPECT_LT(over_time(stays), 0.004);
}

TEST(Unexplained, PeriodicForceIsALine) {
  const Left left =
      left_of([](double t, double, double) { return 0.1 * std::sin(2 * std::numbers::pi * 0.7 * t); });
  ASSERT_TRUE(left.line);
  EXPECT_THAT(left.line->variable, testing::HasSubstr("0.7 Hz"));
  EXPECT_EQ(left.line->output, kTrolleyPosition);
}

/// The drive answers the command 7.5 ms late: a force with the frequency of the command.
TEST(Unexplained, ForceOfAPeriodicMotionIsNoLine) {
  const configuration::Rig rig = axis_with_viscous_friction();
  const auto late = [](double t, double, double) { return -0.04 * std::cos(2 * std::numbers::pi * 1.7 * t); };
  const Conditions periodic{.command_hz = 1.7};
  const Runs runs{moved(rig, 20, 1, late, periodic), moved(rig, 20, 2, late, periodic)};
  const Left left = left_in(runs, rig);
  EXPECT_FALSE(left.line) << left.line->variable;
  const Pieces pieces = pieces_of(runs, replays_of(runs, {rig.plant, rig.terms}), kTrolleyPosition);
  EXPECT_TRUE(find_force_line(pieces, 1))
      << "without the commands it is none either: this test proves nothing";
}

TEST(Unexplained, PeriodicForceBesideAPeriodicCommandIsALine) {
  const configuration::Rig rig = axis_with_viscous_friction();
  const auto shaken = [](double t, double, double) {
    return 0.05 * std::sin(2 * std::numbers::pi * 1.1 * t);
  };
  const Conditions periodic{.command_hz = 1.7};
  const Left left = left_in({moved(rig, 20, 1, shaken, periodic), moved(rig, 20, 2, shaken, periodic)}, rig);
  ASSERT_TRUE(left.line);
  EXPECT_NEAR(left.line->hz, 1.1, 0.03);
}

/// The controller answers the force with a command of the same frequency.
TEST(Unexplained, PeriodicForceOnAControlledAxisIsALine) {
  const configuration::Rig rig = axis_with_viscous_friction();
  const auto shaken = [](double t, double, double) {
    return 0.05 * std::sin(2 * std::numbers::pi * 0.9 * t);
  };
  const Conditions controlled{.controlled = true};
  const Left left =
      left_in({moved(rig, 30, 1, shaken, controlled), moved(rig, 30, 2, shaken, controlled)}, rig);
  ASSERT_TRUE(left.line);
  EXPECT_NEAR(left.line->hz, 0.9, 0.03);
}

TEST(Unexplained, BrakeThatGripsIntermittentlyIsAJumpOfTheSpeed) {
  const Left left = left_of(
      [](double t, double, double v) { return std::fmod(t, 3.0) > 2.7 ? -2.0 * std::tanh(v / 1e-3) : 0.0; });
  ASSERT_TRUE(left.jumps);
  EXPECT_THAT(left.jumps->variable, testing::StartsWith("trolley: jumps of the speed"));
}

/// A slow force that the noise model does not contain.
TEST(Unexplained, SlowForceIsNoJump) {
  const auto slow = [](double t, double, double) { return 0.05 * std::sin(0.2 * t); };
  const configuration::Rig rig = axis_with_viscous_friction();
  const Runs usual{moved(rig, 30, 1, nothing, {.disturbance_v = 0})},
      pushed{moved(rig, 30, 1, slow, {.disturbance_v = 0})};
  const Crane crane{rig.plant, rig.terms};
  const Pieces of_usual = pieces_of(usual, replays_of(usual, crane), kTrolleyPosition);
  EXPECT_FALSE(
      find_jumps(pieces_of(pushed, replays_of(pushed, crane), kTrolleyPosition, of_usual.disturbance)));
}

TEST(Unexplained, EncoderThatLosesCountsIsAJumpOfThePosition) {
  const configuration::Rig rig = axis_with_viscous_friction();
  Runs runs;
  for (const unsigned seed : {1U, 2U}) {
    diagnosis::Run run = moved(rig, 30, seed, nothing).run;
    double slipped = 0;
    for (std::size_t k = 0; k < run.rows(); ++k) {
      if (k % 170 == 100) slipped += 3e-4;
      run.measured[kTrolleyPosition][k] += slipped;
    }
    runs.push_back(prepare(std::move(run), rig));
  }
  const Left left = left_in(runs, rig);
  ASSERT_TRUE(left.jumps);
  EXPECT_THAT(left.jumps->variable, testing::StartsWith("trolley: jumps of the position"));
}

/// At least 72 of 80 true values are within two standard deviations, which are at most 1.5 %. With a
/// probability of 95 %, fewer are inside in 1 % of such tests. The disturbance correlates over neighbouring
/// blocks.
TEST(Intervals, ContainTheTruthAndAreNarrow) {
  configuration::Rig rig = axis_with_viscous_friction();
  rig.terms.clear();
  constexpr int kBodies = 80;
  int inside = 0;
  double width = 0;
  for (unsigned seed = 10; seed < 10 + kBodies; ++seed) {
    const Runs train{moved(rig, 60, 2 * seed, nothing)}, test{moved(rig, 10, 2 * seed + 1, nothing)};
    const Study study(rig, train, test);
    const auto viscous = std::find_if(study.candidates().begin(), study.candidates().end(),
                                      [](const Candidate& c) { return c.cause == "viscous_friction"; });
    const WhitenedData data(study, learnt_nuisance(study, {{&*viscous, {kViscous_vspm}}}));
    const Fitted fitted =
        with_intervals(data, fit(data, {{&*viscous, {0.1}}}, kNothingToBeat, data.base()), seed);
    const double error = fitted.effects[0].values[0] - kViscous_vspm;
    EXPECT_LT(std::abs(error), 0.05 * kViscous_vspm) << "seed " << seed;
    inside += std::abs(error) <= 2 * fitted.interval_std_dev[0] ? 1 : 0;
    width += fitted.interval_std_dev[0] / kViscous_vspm / kBodies;
  }
  EXPECT_GE(inside, 72);
  EXPECT_LT(width, 0.015);
}

}  // namespace
}  // namespace crane::diagnosis
