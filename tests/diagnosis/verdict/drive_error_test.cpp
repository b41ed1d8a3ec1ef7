/// Test of the error of a drive against noise and accuracy of the rig file.
#include <gtest/gtest.h>

#include <cmath>

#include "laboratory/amplifier_runs.hpp"
#include "laboratory/data_of_truth.hpp"

namespace crane::diagnosis {
namespace {

TEST(DriveErrorInWindows, IsExplainedByAnInaccurateRigFile) {
  for (const std::uint64_t seed : {3, 4}) {
    SCOPED_TRACE(seed);
    const DriveError error = error_in(runs_of_axis({}, seed), rig_of_axis());
    EXPECT_GE(error.rms.size(), 30U);
    EXPECT_EQ(p_value(error), 1);
  }
}

/// p value of the exact rig file on two runs with a random force on the drive, correlation time 0.5 s.
double p_value_beside_force(double force_v, std::uint64_t seed) {
  strange::Axis axis;
  axis.disturbance_v = force_v;
  std::vector<diagnosis::Run> runs;
  for (const std::uint64_t run : {1, 2})
    for (diagnosis::Run& piece :
         load_run(strange::recorded_axis(axis, 16, 10 * seed + run), rig_of_axis(), "axis.csv").runs)
      runs.push_back(std::move(piece));
  return p_value(error_in(std::move(runs), rig_of_axis()));
}

/// Forces of 0.8 % and of 6 % of the largest voltage, 10 V.
TEST(DriveErrorInWindows, IsExplainedByACredibleRandomForceOnly) {
  for (const std::uint64_t seed : {3, 4, 5}) {
    SCOPED_TRACE(seed);
    EXPECT_GT(p_value_beside_force(0.08, seed), 0.01);
    EXPECT_LT(p_value_beside_force(0.6, seed), 1e-3);
  }
}

/// The generator's gantry has no friction; its drives have disturbances of up to 0.05 V.
TEST(DriveErrorInWindows, IsExplainedByADisturbanceOfAnAxisWithoutFriction) {
  truth::Case request{.rig = "gantry", .effects = {}, .seed = 4, .seconds = 20};
  const configuration::Rig rig = score::rig_file_of(request.rig);
  std::vector<diagnosis::Run> runs;
  for (const truth::Run& run : truth::generate(request).training)
    for (diagnosis::Run& piece :
         load_run(recording::parse_csv(truth::csv(run), run.file), rig, run.file).runs)
      runs.push_back(std::move(piece));
  EXPECT_EQ(p_value(error_in(std::move(runs), rig)), 1);
}

TEST(DriveErrorInWindows, IsSignificantIfTheAmplifierLimitsTheRateInFewWindows) {
  const DriveError error = error_in(runs_of_axis({.rate_vps = 100}, 5), rig_of_axis());
  EXPECT_LT(p_value(error), 1e-3);
  std::size_t small = 0;
  for (std::size_t w = 0; w < error.rms.size(); ++w) small += error.rms[w] < error.expected[w] ? 1 : 0;
  EXPECT_GT(2 * small, error.rms.size()) << "most windows are explained";
}

TEST(DriveErrorInWindows, HasTheBinomialPValue) {
  DriveError error;
  error.rms.assign(40, 1.0);
  error.expected.assign(40, 1.0);
  EXPECT_EQ(p_value(error), 1);
  constexpr double kOne = 0.0026997960632601866;  // P(|normal| > 3)
  error.rms[7] = 3.01;
  EXPECT_NEAR(p_value(error), 1 - std::pow(1 - kOne, 40), 1e-12);
  error.rms[8] = 3.01;
  EXPECT_NEAR(p_value(error), 1 - std::pow(1 - kOne, 40) - 40 * kOne * std::pow(1 - kOne, 39), 1e-12);
}

/// Without the term of a limited rate and the terms that imitate it, the cause is unknown.
Diagnosis without_limited_rate(const strange::Axis& axis) {
  Request request;
  request.most_effects = 1;
  request.excluded = {"command_rate_limit", "command_saturation", "actuator_lag", "command_delay",
                      "backlash"};
  return diagnose(rig_of_axis(), inaccurate_runs_of(axis, 6), inaccurate_runs_of(axis, 7), request);
}

TEST(DriveErrorInWindows, MakesTheVerdictUnknown) {
  strange::Axis axis;
  axis.amplifier.rate_vps = 100;
  const Diagnosis found = without_limited_rate(axis);
  EXPECT_EQ(found.verdict, Verdict::unknown) << found.sentence;
  EXPECT_NE(found.sentence.find("noise and accuracy of the rig file explain"), std::string::npos)
      << found.sentence;
}

TEST(DriveErrorInWindows, MakesTheVerdictUnknownAlsoBesideACause) {
  strange::Axis axis;
  axis.amplifier.rate_vps = 100;
  axis.coulomb_v *= 1.6;
  const Diagnosis found = without_limited_rate(axis);
  EXPECT_EQ(found.verdict, Verdict::unknown) << found.sentence;
  EXPECT_NE(found.sentence.find("noise and accuracy of the rig file explain"), std::string::npos)
      << found.sentence;
}

}  // namespace
}  // namespace crane::diagnosis
