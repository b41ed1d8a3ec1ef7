/// Effects within the accuracy of a rig file do not decide the verdict.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "crane/diagnosis/diagnosis.hpp"
#include "laboratory/expect_cause.hpp"
#include "laboratory/strange_lab.hpp"
#include "study/study.hpp"
#include "verdict/stated_accuracy.hpp"

namespace crane::diagnosis {
namespace {

configuration::Rig accurate_lab() { return configuration::load_rig(CRANE_RIGS "/gantry.toml"); }

constexpr double kFileRow_s = 0.01, kCount_rad = 1e-3;

/// The command of the file, constant from row to row.
double file_command(double begin_s, double time_s) {
  return strange::rich_command(begin_s + kFileRow_s * std::floor(time_s / kFileRow_s + 1e-6));
}

/// Sensor value over true value.
struct Scales {
  double position = 1, swing = 1;
};

/// @param delay_s delay of the command between controller and motor
/// @param amplitude of the command, times that of the file
std::vector<Run> runs_of_gantry(const strange::Gantry& gantry, double delay_s, double begin_s,
                                const Scales& scales = {}, double amplitude = 1) {
  const auto delayed = [&](double t) {
    return amplitude * file_command(begin_s, std::max(0.0, t - delay_s));
  };
  auto table = strange::recorded(strange::moved(gantry, 24, delayed),
                                 {.row_s = kFileRow_s, .position_step_m = 1e-6, .swing_step_rad = 1e-5});
  for (std::size_t row = 0; row < table.columns[0].values.size(); ++row)
    table.columns[1].values[row] = amplitude * file_command(begin_s, table.columns[0].values[row]);
  for (double& position : table.columns[2].values) position *= scales.position;
  for (double& swing : table.columns[3].values) swing *= scales.swing;
  return load_run(table, accurate_lab(), "gantry.csv").runs;
}

Diagnosis diagnosed(const strange::Gantry& gantry, double delay_s, const Scales& scales = {},
                    const configuration::Rig& rig = accurate_lab()) {
  Request request;
  request.most_effects = 1;
  return diagnose(rig, runs_of_gantry(gantry, delay_s, 0, scales),
                  runs_of_gantry(gantry, delay_s, 40, scales), request);
}

double calibrated_value(const Diagnosis& found, const std::string& name) {
  const auto quantity =
      std::ranges::find_if(found.calibrated, [&](const Calibrated& one) { return one.name == name; });
  return quantity == found.calibrated.end() ? std::numeric_limits<double>::quiet_NaN()
                                            : quantity->parameters.at(0).value;
}

TEST(StatedAccuracy, MakesNoCauseOfASmallErrorThatAFineSensorShows) {
  const Diagnosis found = diagnosed({.gain_mps2pv = 1.2 * 1.01}, 0.004);
  EXPECT_EQ(found.verdict, Verdict::none) << found.sentence;
  EXPECT_EQ(found.sentence, "These data show no error of the model beyond the accuracy of the rig file.");
  EXPECT_NEAR(calibrated_value(found, "motor_gain"), 1.01, 0.002);
  EXPECT_NEAR(calibrated_value(found, "command_delay"), 0.004, 0.0005);
  EXPECT_EQ(found.extension.size(), found.calibrated.size()) << "only the calibrated values";
}

/// The swing follows from the measured motion of the support: the error of its scale and that of the position
/// add.
TEST(StatedAccuracy, MakesNoCauseOfTwoSmallErrorsOfScaleThatAdd) {
  const Diagnosis found = diagnosed({}, 0, {.position = 1.017, .swing = 0.983});
  EXPECT_EQ(found.verdict, Verdict::none) << found.sentence;
}

TEST(StatedAccuracy, NamesAnErrorOfScaleThatTwoSmallErrorsDoNotExplain) {
  const Diagnosis found = diagnosed({}, 0, {.position = 1, .swing = 0.93});
  EXPECT_NE(found.verdict, Verdict::none) << found.sentence;
  EXPECT_NE(found.verdict, Verdict::unknown) << found.sentence;
}

TEST(StatedAccuracy, NamesALargeErrorBesideASmallOne) {
  const Diagnosis found = diagnosed({.gain_mps2pv = 1.2 * 1.01}, 0.03);
  ASSERT_NO_FATAL_FAILURE(expect_cause(found, "command_delay", 0.03, 0.002));
  EXPECT_NEAR(calibrated_value(found, "motor_gain"), 1.01, 0.002);
  EXPECT_TRUE(std::isnan(calibrated_value(found, "command_delay"))) << "the cause has the whole value";
}

/// An error of the friction within its accuracy hides no other cause and is not added to its value.
TEST(StatedAccuracy, KeepsTheValueOfACauseApartFromErrorsOfOtherQuantities) {
  strange::Gantry gantry;
  gantry.gain_mps2pv *= 0.985;
  gantry.cable_m *= 1.3;
  const Diagnosis found = diagnosed(gantry, 0);
  ASSERT_EQ(found.verdict, Verdict::parameter) << found.sentence;
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes[0].name, "cable_length");
  EXPECT_NEAR(found.causes[0].parameters.at(0).value, 0.3 * strange::Gantry{}.cable_m, 0.02);
}

/// The data show the ratio of the load mass to the mass of the trolley, which is lighter than in the rig
/// file, within the accuracy.
TEST(StatedAccuracy, OfTheTrolleyMassWidensTheIntervalOfTheLoadMass) {
  strange::Gantry gantry;
  gantry.inertia_kg *= 0.985;
  gantry.load_kg *= 1.3;
  const Diagnosis found = diagnosed(gantry, 0);
  ASSERT_EQ(found.causes.size(), 1U) << found.sentence;
  EXPECT_EQ(found.causes[0].name, "payload_mass");
  const auto& delta = found.causes[0].parameters.at(0);
  EXPECT_NEAR(delta.value, gantry.load_kg - strange::Gantry{}.load_kg, 1.96 * delta.std_dev);
  EXPECT_LT(delta.std_dev, 0.02 * gantry.load_kg);
}

/// The accuracy of a Coulomb friction of 0 V is 0 V: this quantity is not fitted, the others are.
TEST(StatedAccuracy, IsUsedForADriveWithViscousFrictionOnly) {
  constexpr double kViscous_vspm = 0.1;
  configuration::Rig rig = accurate_lab();
  rig.terms.push_back({"drive_friction",
                       "trolley",
                       {{"viscous_positive_vspm", kViscous_vspm}, {"viscous_negative_vspm", kViscous_vspm}}});
  strange::Gantry gantry;
  gantry.drag_nspm = kViscous_vspm * gantry.inertia_kg * gantry.gain_mps2pv;
  gantry.gain_mps2pv *= 1.01;
  gantry.cable_m *= 1.3;
  const Diagnosis found = diagnosed(gantry, 0, {}, rig);
  ASSERT_EQ(found.causes.size(), 1U) << found.sentence;
  EXPECT_EQ(found.causes[0].name, "cable_length");
  EXPECT_GT(found.causes[0].parameters.at(0).std_dev, 0);
  EXPECT_NEAR(calibrated_value(found, "motor_gain"), 1.01, 0.002);
}

/// Free swings of a load; noise makes the mean of the encoder finer than its count.
std::vector<Run> free_swings(const std::vector<double>& starts_rad, double offset_rad) {
  std::vector<Run> runs;
  for (const double start_rad : starts_rad) {
    auto truth = strange::moved(
        {}, 8, [](double) { return 0.0; }, start_rad);
    for (strange::Instant& instant : truth) instant.swing_rad += offset_rad;
    const auto table = strange::recorded(
        truth, {.row_s = kFileRow_s, .swing_step_rad = kCount_rad, .swing_noise_rad = 3e-4});
    for (Run& run : load_run(table, accurate_lab(), "swing.csv").runs) runs.push_back(std::move(run));
  }
  return runs;
}

/// The load hangs somewhere within one count when an incremental encoder is zeroed.
TEST(StatedAccuracy, ContainsTheErrorOfTheZeroOfAnEncoderUpToHalfACount) {
  for (const double counts : {0.35, 3.0}) {
    const double offset_rad = counts * kCount_rad;
    const Diagnosis found = diagnose(accurate_lab(), free_swings({0.15, -0.1}, offset_rad),
                                     free_swings({0.12}, offset_rad), {.most_effects = 1, .accuracy = {}});
    if (counts < 0.5)
      EXPECT_EQ(found.verdict, Verdict::none) << found.sentence;
    else
      EXPECT_TRUE(found.verdict == Verdict::named || found.verdict == Verdict::ambiguous) << found.sentence;
  }
}

/// A ripple of 0.03 to 0.3 V alternates quickly: it changes the position less than the stated inaccuracies
/// do. From 0.06 V on, it changes the acceleration more than they do.
TEST(StatedAccuracy, ContainsAQuickForceOnlyIfItIsSmallAsAForce) {
  constexpr double kWavelength_m = 0.02, kLarge_v = 0.15, kSmall_v = 0.005;
  const configuration::Rig rig = accurate_lab();
  Runs train, none;
  for (diagnosis::Run& run : runs_of_gantry({}, 0, 0)) train.push_back(prepare(std::move(run), rig));
  const Study study(rig, train, none, {}, kUsualAccuracy);
  const auto ripple = std::ranges::find(study.candidates(), std::string{"torque_ripple"}, &Candidate::cause);
  ASSERT_NE(ripple, study.candidates().end());
  const auto contains = [&](double amplitude_v) -> bool {
    Fitted fitted;
    fitted.effects = {{&*ripple, {amplitude_v, 0, kWavelength_m}}};
    fitted.interval_std_dev = {0, 0, 0};
    return StatedAccuracy(rig, kUsualAccuracy).contains_each(study, fitted).front();
  };
  EXPECT_FALSE(contains(kLarge_v));
  EXPECT_TRUE(contains(kSmall_v));
}

TEST(StatedAccuracy, DoesNotContainALimitOfTheAmplifierThatOnlyTheHeldOutRunReaches) {
  const configuration::Rig rig = accurate_lab();
  Runs train, test;
  for (diagnosis::Run& run : runs_of_gantry({}, 0, 0)) train.push_back(prepare(std::move(run), rig));
  for (diagnosis::Run& run : runs_of_gantry({}, 0, 40, {}, 2)) test.push_back(prepare(std::move(run), rig));
  double largest_v = 0;
  for (int row = 0; row < 2400; ++row)
    largest_v = std::max(largest_v, std::abs(file_command(0, row * kFileRow_s)));
  const Study study(rig, train, test, {}, kUsualAccuracy);
  const auto limit =
      std::ranges::find(study.candidates(), std::string{"command_saturation"}, &Candidate::cause);
  ASSERT_NE(limit, study.candidates().end());
  const auto contains = [&](double limit_v) -> bool {
    Fitted fitted;
    fitted.effects = {{&*limit, {limit_v}}};
    fitted.interval_std_dev = {0};
    return StatedAccuracy(rig, kUsualAccuracy).contains_each(study, fitted).front();
  };
  EXPECT_FALSE(contains(1.01 * largest_v));
  EXPECT_TRUE(contains(3 * largest_v));
}

/// A mean over a window delays by half the window: the accuracy of times is half a control period.
TEST(StatedAccuracy, ContainsAMeanOfTheSwingOverOneControlPeriod) {
  const configuration::Rig rig = accurate_lab();
  Runs train, none;
  for (diagnosis::Run& run : runs_of_gantry({}, 0, 0)) train.push_back(prepare(std::move(run), rig));
  const Study study(rig, train, none, {}, kUsualAccuracy);
  const auto mean =
      std::ranges::find(study.candidates(), std::string{"swing_moving_average"}, &Candidate::cause);
  ASSERT_NE(mean, study.candidates().end());
  const auto contains = [&](double window_s) -> bool {
    Fitted fitted;
    fitted.effects = {{&*mean, {window_s}}};
    fitted.interval_std_dev = {0};
    return StatedAccuracy(rig, kUsualAccuracy).contains_each(study, fitted).front();
  };
  EXPECT_TRUE(contains(0.9 * rig.period_s));
  EXPECT_FALSE(contains(1.1 * rig.period_s));
}

TEST(StatedAccuracy, ContainsAPatternThatIsSmallBesideTheFriction) {
  configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/drive_axis.toml");
  const double gain = rig.plant.trolley_gain_mps2pv;
  double coulomb_v = 0;
  for (const plant::TermSetting& term : rig.terms)
    if (term.name == "drive_friction" && term.axis == "trolley")
      coulomb_v =
          std::min(term.parameters.at("coulomb_positive_v"), term.parameters.at("coulomb_negative_v"));
  ASSERT_GT(coulomb_v, 0);
  const StatedAccuracy accuracy(rig, kUsualAccuracy), exact(rig, {});
  Unexplained pattern;
  pattern.acceleration = 0.04 * coulomb_v * gain;
  EXPECT_TRUE(accuracy.contains(pattern));
  EXPECT_FALSE(exact.contains(pattern));
  pattern.acceleration = 0.06 * coulomb_v * gain;
  EXPECT_FALSE(accuracy.contains(pattern));
  pattern.acceleration = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(accuracy.contains(pattern)) << "a line or a jump";
}

}  // namespace
}  // namespace crane::diagnosis
