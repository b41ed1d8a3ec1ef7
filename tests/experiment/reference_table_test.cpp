/// Compares runs of the whole stack with figures of an independent simulation of the same crane and laws
/// (full nonlinear model, 100 Hz, true states, no delay). Explanations: docs/comparison.md.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/comparison_run.hpp"
#include "stack/data_files.hpp"

namespace crane::experiment {
namespace {

constexpr double kNot = std::numeric_limits<double>::quiet_NaN();  // not in the reference
constexpr double kDegrees = 180 / std::numbers::pi;

struct Row {
  const char* controller;
  const char* variant;
  int maneuver;
  double settle_s;
  double trolley;  ///< overshoot in %; maneuver 2: largest deviation in cm
  double slew;     ///< overshoot in %
  double radial_deg, tangential_deg, trolley_v, slew_v;
};

std::ostream& operator<<(std::ostream& out, const Row& row) {
  return out << row.controller << ", " << row.variant << ", maneuver " << row.maneuver;
}

/// Values that the reference does not have are not compared. The tolerance is 10 %, at least `floor`: the
/// reference is rounded to 0.1 of its unit.
void expect_near(double ours, double reference, double floor, const char* what) {
  if (std::isnan(reference)) return;
  EXPECT_NEAR(ours, reference, std::max(0.1 * std::abs(reference), floor)) << what;
}

class ReferenceTable : public testing::TestWithParam<Row> {};

TEST_P(ReferenceTable, HoldsWithinTenPercent) {
  const Row& row = GetParam();
  const auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower"));
  const auto scenario = load_scenario(stack::find_scenario("maneuver_" + std::to_string(row.maneuver)), &rig);
  const auto run =
      experiments::simulate({scenario, rig, control::find_controller(row.controller), row.variant});
  ASSERT_EQ(run.stopped_because, "");
  const Metrics& ours = run.metrics.value();
  ASSERT_TRUE(ours.settling_time_s);
  expect_near(*ours.settling_time_s, row.settle_s, 0, "settling time");
  // Half of the band within which an axis counts as arrived.
  constexpr double kOvershoot_percent = 1, kSwing_deg = 0.15, kVolts = 0.15;
  expect_near(row.maneuver == 2 ? 100 * ours.deviation[plant::kTrolley].value()
                                : ours.overshoot_percent[plant::kTrolley].value(),
              row.trolley, kOvershoot_percent, "trolley");
  expect_near(ours.overshoot_percent[plant::kSlew].value_or(kNot), row.slew, kOvershoot_percent, "slew");
  expect_near(ours.largest_swing_radial_rad * kDegrees, row.radial_deg, kSwing_deg, "radial swing");
  expect_near(ours.largest_swing_tangential_rad * kDegrees, row.tangential_deg, kSwing_deg,
              "tangential swing");
  expect_near(ours.largest_v[plant::kTrolley], row.trolley_v, kVolts, "trolley volts");
  expect_near(ours.largest_v[plant::kSlew], row.slew_v, kVolts, "slew volts");
  EXPECT_LT(ours.residual_swing_rad * kDegrees, 0.1);
}

std::string title(const testing::TestParamInfo<Row>& test) {
  std::string name = std::string{test.param.controller} + "_" + test.param.variant + "_maneuver_" +
                     std::to_string(test.param.maneuver);
  std::replace(name.begin(), name.end(), '+', '_');
  return name;
}

constexpr const char* kPartial = "gain_scheduling_partial";
constexpr const char* kFull = "gain_scheduling_full";
constexpr const char* kIdeal = "ideal+unfiltered";
constexpr const char* kIdeal2 = "ideal+unfiltered+full_gain_2";
constexpr const char* kIdeal8 = "ideal+unfiltered+full_gain_8";

INSTANTIATE_TEST_SUITE_P(
    IdealPlant, ReferenceTable,
    testing::Values(Row{kPartial, kIdeal, 1, 3.38, 0, kNot, 5.6, kNot, 2.9, kNot},
                    Row{kPartial, kIdeal, 2, 4.61, 17.4, .1, 5.3, 10.5, .2, 10},
                    Row{kPartial, kIdeal, 3, 4.82, 6.1, 0, 6.0, 3.6, 2.9, 10},
                    Row{kFull, kIdeal2, 1, 3.44, 0, kNot, 4.3, kNot, 1.5, kNot},
                    Row{kFull, kIdeal2, 2, 5.07, 17.2, .7, 4.0, 5.7, .2, 3.1},
                    Row{kFull, kIdeal2, 3, 5.50, 9.1, .1, 4.4, 2.7, 1.5, 3.1},
                    Row{kFull, kIdeal, 1, 3.38, 0, kNot, 5.7, kNot, 3.0, kNot},
                    Row{kFull, kIdeal, 2, 4.76, 16.6, .2, 4.8, 7.9, .2, 6.3},
                    Row{kFull, kIdeal, 3, 5.04, 7.1, 0, 5.9, 3.4, 3.0, 6.3},
                    Row{kFull, kIdeal8, 1, 3.30, 0, kNot, 7.3, kNot, 6.0, kNot},
                    Row{kFull, kIdeal8, 2, 4.50, 15.1, .1, 5.3, 10.5, .2, 10},
                    Row{kFull, kIdeal8, 3, 4.64, 5.4, 0, 7.7, 4.2, 6.0, 10},
                    Row{"delayed_1", kIdeal, 1, 5.13, 14.3, kNot, 8.4, kNot, .8, kNot},
                    Row{"delayed_1", kIdeal, 2, 5.43, 18.8, 14.3, 13.8, 20.7, .4, 3.4},
                    Row{"delayed_1", kIdeal, 3, 5.56, 26.0, 9.0, 14.9, 16.4, .8, 2.2},
                    Row{"anti_swing_pd", kIdeal, 1, 4.30, 8.4, kNot, 8.9, kNot, .9, kNot},
                    Row{"anti_swing_pd", kIdeal, 2, 5.09, 13.7, 11.3, 18.2, 23.7, .8, 4.5},
                    Row{"anti_swing_pd", kIdeal, 3, 5.16, 15.1, 9.5, 15.6, 26.0, .9, 2.7}),
    title);

/// The rig with friction, sensors and filters; the reference has only settling times for it.
Row settling(const char* controller, const char* variant, int maneuver, double settle_s) {
  return {controller, variant, maneuver, settle_s, kNot, kNot, kNot, kNot, kNot, kNot};
}
constexpr const char* kExact = "exact_compensation";
constexpr const char* kExact2 = "exact_compensation+full_gain_2";
constexpr const char* kExact8 = "exact_compensation+full_gain_8";

INSTANTIATE_TEST_SUITE_P(
    FrictionCompensatedExactly, ReferenceTable,
    testing::Values(settling(kPartial, kExact, 1, 3.39), settling(kPartial, kExact, 2, 4.66),
                    settling(kPartial, kExact, 3, 4.88), settling(kFull, kExact2, 1, 3.45),
                    settling(kFull, kExact2, 2, 5.11), settling(kFull, kExact2, 3, 5.56),
                    settling(kFull, kExact8, 1, 3.31), settling(kFull, kExact8, 2, 4.54),
                    settling(kFull, kExact8, 3, 4.68), settling("delayed_1", kExact, 1, 5.23),
                    settling("delayed_1", kExact, 2, 5.27), settling("delayed_1", kExact, 3, 5.66)),
    title);

}  // namespace
}  // namespace crane::experiment
