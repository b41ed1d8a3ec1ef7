/// Whole diagnoses of data by a generator of its own.
#include <gmock/gmock.h>

#include "crane/innovations/diagnose.hpp"
#include "fit/ascent.hpp"
#include "likelihood/problem.hpp"
#include "rigs.hpp"

namespace crane::innovations::test {
namespace {

using diagnosis::Verdict;

/// @param believed what the rig file says, @param real what is measured
Result diagnosed(const SampleCrane& believed, const SampleCrane& real, unsigned seed, double seconds = 10) {
  const bool load = real.load_kg > 0;
  std::vector<innovations::Run> train{run_of(SampleRun{real, seed}.rows(seconds), load),
                                      run_of(SampleRun{real, seed + 1}.rows(seconds), load)};
  diagnosis::Request request;
  request.most_effects = 1;
  return diagnose(rig_of(believed), train, {run_of(SampleRun{real, seed + 2}.rows(seconds), load)}, request);
}

std::string first_name(const Result& r) {
  return r.diagnosis.causes.empty() ? "" : r.diagnosis.causes[0].name;
}

TEST(Diagnosis, FindsNothingWrongWhereNothingIs) {
  const Result r = diagnosed({}, {}, 11);
  EXPECT_EQ(r.diagnosis.verdict, Verdict::none) << r.diagnosis.sentence;
}

TEST(Diagnosis, NamesViscousFriction) {
  SampleCrane real;
  real.viscous_vs = 4;
  const Result r = diagnosed({}, real, 31);
  EXPECT_EQ(first_name(r), "viscous_friction") << r.diagnosis.sentence;
  EXPECT_NEAR(r.diagnosis.causes.at(0).parameters.at(0).value, 1, 0.1);
}

/// Not reached: a dead zone of the command is named.
TEST(Diagnosis, DISABLED_NamesDryFrictionThoughItsMemoryIsNoneOfTheLaws) {
  SampleCrane real;
  real.coulomb_v = 1.1;
  const Result r = diagnosed({}, real, 41);
  EXPECT_EQ(first_name(r), "coulomb_friction") << r.diagnosis.sentence;
  EXPECT_NEAR(r.diagnosis.causes.at(0).parameters.at(0).value, 0.3, 0.03);
}

/// Not reached: command noise is learnt in its place.
TEST(Diagnosis, DISABLED_NamesACommandDelayOfThreeRowsAndAHalf) {
  SampleCrane real;
  real.delay_s = 0.035;
  const Result r = diagnosed({}, real, 51);
  EXPECT_EQ(first_name(r), "command_delay") << r.diagnosis.sentence;
  EXPECT_NEAR(r.diagnosis.causes.at(0).parameters.at(0).value, 0.035, 0.001);
}

/// Not reached, see docs/innovations.md.
TEST(Diagnosis, DISABLED_NamesASwingSensorThatIsLate) {
  SampleCrane believed, real;
  believed.load_kg = real.load_kg = 2;
  real.swing_delay_s = 0.06;
  const Result r = diagnosed(believed, real, 61, 12);
  EXPECT_EQ(first_name(r), "swing_delay") << r.diagnosis.sentence;
  EXPECT_NEAR(r.diagnosis.causes.at(0).parameters.at(0).value, 0.06, 0.002);
}

TEST(Rows, ThatAreMissingOrLateChangeTheEstimateByNoMoreThanItsNoise) {
  SampleCrane believed, real;
  real.viscous_vs = 4;
  const auto even = run_of(SampleRun{real, 71}.rows(10), false);
  std::mt19937 random{72};
  const auto uneven = thinned(even, [&](double t) { return random() % 3 != 0 && !(t > 4 && t < 5.5); });
  std::vector<double> values, deviations;
  for (const auto& run : {even, uneven}) {
    const Problem problem{rig_of(believed), {run}};
    std::vector<Index> free = problem.noise();
    free.push_back(of_axis(0, kViscous));
    const Fit fit = ascend(problem, {problem.base, {}}, free, {12, 0.2});
    values.push_back(fit.at.values[of_axis(0, kViscous)]);
    deviations.push_back(std::sqrt(sandwich(problem, fit, {of_axis(0, kViscous)}).covariance(0, 0)));
  }
  EXPECT_NEAR(values[0], values[1], 3 * std::hypot(deviations[0], deviations[1]));
  EXPECT_NEAR(values[1], 1, 0.15);
}

/// Tables of a few dozen rows with whatever may stand in a file.
TEST(SmallData, OfAnyKindAreDiagnosedOrRefused) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random{seed};
  std::normal_distribution<double> n;
  for (int trial = 0; trial < 12; ++trial) {
    SampleCrane crane;
    crane.load_kg = random() % 2 == 0 ? 2 : 0;
    const auto rows = 5 + random() % 60;
    recording::Table table;
    table.columns = {
        {"time_s", {}}, {"trolley_voltage_v", {}}, {"trolley_position_m", {}}, {"swing_radial_rad", {}}};
    if (random() % 4 == 0) table.columns.erase(table.columns.begin() + 1);
    const double size = std::pow(10, 2 * n(random));
    double t = 0;
    for (std::size_t k = 0; k < rows; ++k) {
      t += random() % 10 == 0 ? -0.01 : 0.02 * std::abs(n(random));
      for (auto& c : table.columns)
        c.values.push_back(c.name == "time_s" ? t : random() % 9 == 0 ? NAN : size * n(random));
    }
    diagnosis::Request request;
    request.most_effects = 1;
    try {
      const auto rig = rig_of(crane);
      const auto run = load_run(table, rig, "random").run;
      const Result r = diagnose(rig, {run}, {run}, request);
      EXPECT_FALSE(r.diagnosis.sentence.empty());
    } catch (const DataProblem& problem) {
      EXPECT_FALSE(std::string{problem.what()}.empty());
    }
  }
}

}  // namespace
}  // namespace crane::innovations::test
