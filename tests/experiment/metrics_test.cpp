// Signals whose figures of merit follow from a formula.
#include "crane/experiment/metrics.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "rig.hpp"
#include "signals.hpp"

namespace crane::experiment {
namespace {

constexpr double kPi = std::numbers::pi;

/// First-order rise of the trolley with time constant 1 s, no swing: within 2 % from t = ln 50 on.
Sample first_order(double t) {
  Sample s;
  s.position = {1.0 - 0.75 * std::exp(-t), 0, 1};
  return s;
}

TEST(Metrics, SettlingTimeOfAFirstOrderRiseIsLnFiftyTimeConstants) {
  const Metrics m = evaluate(sampled(20, first_order), trolley_move());
  ASSERT_TRUE(m.settling_time_s);
  EXPECT_GE(*m.settling_time_s, std::log(50.0));  // the first sample inside
  EXPECT_LT(*m.settling_time_s, std::log(50.0) + kPeriod_s);
  EXPECT_EQ(m.overshoot_percent[0], 0);
  EXPECT_FALSE(m.deviation[0]);
  EXPECT_EQ(m.deviation[1], 0);
  EXPECT_NEAR(m.final_error[0], -0.75 * std::exp(-20.0), 1e-15);
}

TEST(Metrics, OvershootOfASecondOrderStepFollowsFromItsDamping) {
  for (const double z : {0.2, 0.5, 0.7}) {
    const auto run = sampled(40, [z](double t) {
      Sample s;
      s.position = {1.0, -1.5 * step_response(t, z, 2), 1};  // in the negative direction
      return s;
    });
    const Metrics m = evaluate(run, {0, 0, {1.0, 0, 1}, {1.0, -1.5, 1}});
    // The sampling misses the peak by at most half a period. The response is flat there, so that the error is
    // far below 0.1 %.
    EXPECT_NEAR(*m.overshoot_percent[1], 100 * std::exp(-kPi * z / std::sqrt(1 - z * z)), 0.1) << z;
  }
}

TEST(Metrics, SettlingWaitsForTheSlowestOfAxesAndSwings) {
  const auto swinging = [](double t) {
    Sample s = first_order(t);
    s.swing_tangential_rad = 10 * kPi / 180 * std::exp(-0.5 * t);  // below 0.5 deg from 2 ln 20 on
    return s;
  };
  const Metrics m = evaluate(sampled(20, swinging), trolley_move());
  EXPECT_NEAR(*m.settling_time_s, 2 * std::log(20.0), kPeriod_s);
  EXPECT_NEAR(m.largest_swing_tangential_rad, 10 * kPi / 180, 1e-12);
  EXPECT_EQ(m.largest_swing_radial_rad, 0);
}

TEST(Metrics, AnUnmovedTrolleyMustStayWithinTwoPercentOfTheNominalMove) {
  const auto drifting = [](double offset) {
    return sampled(10, [offset](double t) {
      Sample s;
      s.position = {0.9 + (t < 3 ? 0.1 : offset), kPi / 2, 1};
      return s;
    });
  };
  const Maneuver slew{0, 0, {0.9, 0, 1}, {0.9, kPi / 2, 1}};
  EXPECT_NEAR(*evaluate(drifting(0.0149), slew).settling_time_s, 3, 1e-9);
  EXPECT_FALSE(evaluate(drifting(0.0151), slew).settling_time_s);
  EXPECT_NEAR(*evaluate(drifting(0.0), slew).deviation[0], 0.1, 1e-12);
}

TEST(Metrics, AnUnmovedSlewAxisMustStayWithinTwoPercentOfNinetyDegrees) {
  const auto turned = [](double degrees) {
    return sampled(10, [degrees](double) {
      Sample s;
      s.position = {1.0, degrees * kPi / 180, 1};
      return s;
    });
  };
  EXPECT_EQ(evaluate(turned(1.79), trolley_move()).settling_time_s, 0);
  EXPECT_FALSE(evaluate(turned(-1.81), trolley_move()).settling_time_s);
}

TEST(Metrics, HoistCountsOnlyWhenMoved) {
  const auto run = sampled(10, [](double t) {
    Sample s;
    s.position = {1.0, 0, t < 4 ? 1.0 : 0.7};
    return s;
  });
  EXPECT_EQ(evaluate(run, trolley_move()).settling_time_s, 0);
  const Metrics hoisted = evaluate(run, {0, 0, {0.25, 0, 1}, {1.0, 0, 0.7}});
  EXPECT_NEAR(*hoisted.settling_time_s, 4, 1e-9);
  EXPECT_EQ(hoisted.overshoot_percent[2], 0);
}

TEST(Metrics, ALateExcursionMeansThatItHadNotSettledBefore) {
  const auto run = sampled(20, [](double t) {
    Sample s = first_order(t + 10);
    s.swing_radial_rad = t > 15 && t < 15.5 ? 0.01 : 0;
    return s;
  });
  EXPECT_NEAR(*evaluate(run, trolley_move()).settling_time_s, 15.5, 1.5 * kPeriod_s);
}

TEST(Metrics, ASwingThatStaysMeansNotSettledAndIsTheResidualSwing) {
  const auto run = sampled(20, [](double t) {
    Sample s = first_order(t);
    s.swing_radial_rad = (t < 10 ? 0.3 : 0.02) * std::sin(kPi * t);
    return s;
  });
  const Metrics m = evaluate(run, trolley_move());
  EXPECT_FALSE(m.settling_time_s);
  EXPECT_NEAR(m.residual_swing_rad, 0.02, 1e-9);
  EXPECT_NEAR(m.largest_swing_radial_rad, 0.3, 1e-9);
}

TEST(Metrics, SwingScatterIsTheStandardDeviationInBothPlanes) {
  const auto run = sampled(20, [](double t) {
    Sample s = first_order(t);
    s.swing_radial_rad = 0.05 + 0.03 * std::sin(2 * kPi * t);  // 20 periods about a constant deflection
    s.swing_tangential_rad = 0.04 * std::sin(2 * kPi * t);
    return s;
  });
  EXPECT_NEAR(evaluate(run, trolley_move()).swing_scatter_rad, 0.05 / std::sqrt(2), 1e-4);
}

TEST(Metrics, NotANumberIsNeverSettled) {
  auto run = sampled(5, [](double) { return first_order(20); });
  run.back().position[0] = std::nan("");
  EXPECT_FALSE(evaluate(run, trolley_move()).settling_time_s);
}

TEST(Metrics, TimesCountFromTheLastActionAndFiguresFromTheFirst) {
  const auto run = sampled(30, [](double t) {
    Sample s = first_order(t - 12);  // the last move at 12 s
    if (t < 12) s.position[0] = 0.25;
    s.drive_v[0] = t < 2 ? 9 : t < 3 ? 6 : 1;
    return s;
  });
  const Metrics m = evaluate(run, {2, 12, {0.25, 0, 1}, {1.0, 0, 1}});
  EXPECT_NEAR(*m.settling_time_s, std::log(50.0), kPeriod_s);
  EXPECT_EQ(m.largest_v[0], 6);
  EXPECT_NEAR(m.effort_v2s[0], 36 * 1 + 27, 1e-9);
}

TEST(Metrics, EffortOfAHeldSineIsHalfTheSquareOfItsAmplitudePerSecond) {
  const auto run = sampled(10, [](double t) {
    Sample s = first_order(20);
    s.drive_v[1] = 4 * std::sin(2 * kPi * t);
    return s;
  });
  const Metrics m = evaluate(run, trolley_move());
  EXPECT_NEAR(m.effort_v2s[1], 16 * 0.5 * 10, 1e-9);
  EXPECT_NEAR(m.largest_v[1], 4, 1e-9);
}

TEST(Metrics, CountsTheTicksThatAreMissing) {
  auto run = sampled(5, first_order);
  run.erase(run.begin() + 100, run.begin() + 103);
  run.erase(run.begin() + 50);
  EXPECT_EQ(evaluate(run, trolley_move()).lost_ticks, 4U);
}

TEST(Metrics, RefusesARunItCannotJudge) {
  auto run = sampled(5, first_order);
  EXPECT_THROW((void)evaluate({}, trolley_move()), std::invalid_argument);
  EXPECT_THROW((void)evaluate(run, trolley_move(6)), std::invalid_argument);
  run[10].time_s = run[9].time_s;
  EXPECT_THROW((void)evaluate(run, trolley_move()), std::invalid_argument);
}

TEST(Metrics, TakesTheManeuverFromTheScenario) {
  Scenario scenario;
  scenario.start[0] = 0.3;
  scenario.moves.push_back({0.5, {1.0, std::nullopt, std::nullopt}});
  configuration::Rig rig = tower();
  rig.start.position = {0.25, 0.2, 0.9};
  const Maneuver one = maneuver_of(scenario, rig);
  EXPECT_THAT(one.from, testing::ElementsAre(0.3, 0.2, 0.9));
  EXPECT_THAT(one.to, testing::ElementsAre(1.0, 0.2, 0.9));
  EXPECT_EQ(one.first_action_s, 0.5);
  scenario.moves.push_back({7, {std::nullopt, 1.5, std::nullopt}});
  const Maneuver two = maneuver_of(scenario, rig);
  EXPECT_THAT(two.from, testing::ElementsAre(1.0, 0.2, 0.9));
  EXPECT_THAT(two.to, testing::ElementsAre(1.0, 1.5, 0.9));
  EXPECT_EQ(two.last_action_s, 7);
  scenario.kicks.push_back({9, 0.5, 0});
  EXPECT_EQ(maneuver_of(scenario, rig).from, maneuver_of(scenario, rig).to);
}

TEST(Metrics, ReadsSamplesFromATable) {
  const recording::Table table{{{"time_s", {0, 0.01}},
                                {"trolley_voltage_v", {1, 2}},
                                {"slew_angle_rad", {0.3, 0.4}},
                                {"swing_radial_rad", {0.01, 0.02}},
                                {"tick", {7, 9}}}};
  const std::vector<Sample> samples = samples_from(table);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[1].time_s, 0.01);
  EXPECT_EQ(samples[1].drive_v[0], 2);
  EXPECT_EQ(samples[1].position[1], 0.4);
  EXPECT_EQ(samples[1].position[0], 0);
  EXPECT_EQ(samples[1].swing_radial_rad, 0.02);
  EXPECT_EQ(samples[1].tick, 9U);
  EXPECT_THROW((void)samples_from(recording::Table{{{"tick", {1}}}}), std::invalid_argument);
}

TEST(Metrics, JsonHasDegreesAndNullForMissingFigures) {
  Metrics m;
  m.overshoot_percent[0] = 4.5;
  m.deviation[1] = kPi / 180;
  m.largest_swing_radial_rad = kPi / 18;
  const auto json = to_json(m);
  EXPECT_TRUE(json.at("settling_time_s").is_null());
  EXPECT_EQ(json.at("trolley_overshoot_percent"), 4.5);
  EXPECT_TRUE(json.at("trolley_deviation_m").is_null());
  EXPECT_DOUBLE_EQ(json.at("slew_deviation_deg"), 1);
  EXPECT_DOUBLE_EQ(json.at("largest_swing_radial_deg"), 10);
  EXPECT_EQ(json.at("lost_ticks"), 0);
}

}  // namespace
}  // namespace crane::experiment
