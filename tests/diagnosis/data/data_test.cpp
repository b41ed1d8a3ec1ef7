#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {
namespace {

using recording::Table;
using testing::AllOf;
using testing::HasSubstr;

configuration::Rig tower() {
  return configuration::load_rig(std::string{CRANE_RIGS} + "/virginia_tech_tower.toml");
}

/// Four seconds of plausible motion at 100 Hz.
Table plausible() {
  Table table;
  table.columns = {{"time_s", {}},
                   {"trolley_voltage_v", {}},
                   {"slew_voltage_v", {}},
                   {"trolley_position_m", {}},
                   {"slew_angle_rad", {}},
                   {"swing_radial_rad", {}},
                   {"swing_tangential_rad", {}}};
  for (int k = 0; k < 400; ++k) {
    const double t = 0.01 * k;
    const double values[] = {t,
                             std::sin(t),
                             std::cos(t),
                             0.6 + 0.1 * std::sin(t),
                             0.2 * std::sin(2 * t),
                             0.05 * std::cos(3 * t),
                             0.04 * std::sin(3 * t)};
    for (std::size_t i = 0; i < table.columns.size(); ++i) table.columns[i].values.push_back(values[i]);
  }
  return table;
}

std::vector<double>& column(Table& table, const std::string& name) {
  for (auto& c : table.columns)
    if (c.name == name) return c.values;
  throw std::invalid_argument(name);
}

std::string problem_of(const Table& table) {
  try {
    (void)load_run(table, tower(), "data.csv");
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

TEST(MeasuredData, AreLoadedUnchanged) {
  const Loaded loaded = load_run(plausible(), tower(), "data.csv");
  ASSERT_EQ(loaded.runs.size(), 1U);
  EXPECT_TRUE(loaded.notes.empty());
  EXPECT_EQ(loaded.runs[0].rows(), 400U);
  EXPECT_NEAR(loaded.runs[0].period_s, 0.01, 1e-12);
  EXPECT_DOUBLE_EQ(loaded.runs[0].command_v[100][plant::kTrolley], std::sin(1.0));
}

TEST(MeasuredData, InDegreesAreRefused) {
  Table table = plausible();
  for (double& value : column(table, "swing_radial_rad")) value *= 180 / 3.14159 * 2;
  EXPECT_THAT(problem_of(table),
              AllOf(HasSubstr("data.csv"), HasSubstr("swing_radial_rad"), HasSubstr("check for degrees")));
}

TEST(MeasuredData, InMillimetresAreRefused) {
  Table table = plausible();
  for (double& value : column(table, "trolley_position_m")) value *= 1000;
  EXPECT_THAT(problem_of(table), AllOf(HasSubstr("trolley_position_m"), HasSubstr("check for millimetres")));
}

TEST(MeasuredData, WithoutTheCommandThatMovedTheAxisAreRefused) {
  Table table = plausible();
  std::erase_if(table.columns, [](const auto& c) { return c.name == "slew_voltage_v"; });
  EXPECT_THAT(problem_of(table), AllOf(HasSubstr("slew_voltage_v"), HasSubstr("missing")));
}

TEST(MeasuredData, WithDecreasingTimeAreRefused) {
  Table table = plausible();
  column(table, "time_s")[200] = 1.0;
  EXPECT_THAT(problem_of(table), HasSubstr("time must increase"));
}

TEST(MeasuredData, WithAConstantSensorAreRefused) {
  Table table = plausible();
  for (double& value : column(table, "swing_tangential_rad")) value = 0.01;
  EXPECT_THAT(problem_of(table), AllOf(HasSubstr("swing_tangential_rad"), HasSubstr("constant")));
}

TEST(MeasuredData, OfAnAxisWithoutCommandMayBeConstantWithANote) {
  Table table = plausible();
  for (double& value : column(table, "slew_voltage_v")) value = 0;
  for (double& value : column(table, "slew_angle_rad")) value = 0.3;
  for (double& value : column(table, "swing_tangential_rad")) value = 0;
  const Loaded loaded = load_run(table, tower(), "data.csv");
  ASSERT_EQ(loaded.runs.size(), 1U);
  ASSERT_EQ(loaded.notes.size(), 2U);
  EXPECT_THAT(loaded.notes[0], AllOf(HasSubstr("slew_angle_rad"), HasSubstr("stands still")));
}

TEST(MeasuredData, WithSeveralProblemsNameAll) {
  Table table = plausible();
  for (double& value : column(table, "swing_tangential_rad")) value = 0;
  for (double& value : column(table, "trolley_position_m")) value *= 1000;
  EXPECT_THAT(problem_of(table), AllOf(HasSubstr("swing_tangential_rad"), HasSubstr("trolley_position_m")));
}

TEST(MeasuredData, AreCutAtALongGapWithANote) {
  Table table = plausible();
  for (auto& c : table.columns) c.values.erase(c.values.begin() + 130, c.values.begin() + 290);
  for (double& t : column(table, "time_s")) t *= 2;
  const Loaded loaded = load_run(table, tower(), "data.csv");
  ASSERT_EQ(loaded.runs.size(), 2U);
  EXPECT_EQ(loaded.runs[0].rows(), 130U);
  ASSERT_EQ(loaded.notes.size(), 1U);
  EXPECT_THAT(loaded.notes[0], AllOf(HasSubstr("1 gaps"), HasSubstr("row 131 at 5.8 s")));
}

TEST(MeasuredData, AreCutAtAResetCounterWithANote) {
  Table table = plausible();
  auto& position = column(table, "trolley_position_m");
  for (std::size_t k = 200; k < position.size(); ++k) position[k] -= 0.4;
  const Loaded loaded = load_run(table, tower(), "data.csv");
  EXPECT_EQ(loaded.runs.size(), 2U);
  ASSERT_EQ(loaded.notes.size(), 1U);
  EXPECT_THAT(loaded.notes[0], HasSubstr("jumps"));
}

TEST(MeasuredData, TooShortForASwingAreRefused) {
  Table table = plausible();
  for (auto& c : table.columns) c.values.resize(50);
  EXPECT_THAT(problem_of(table), HasSubstr("record longer"));
}

TEST(Smoothing, IsExactForCubicsUpToTheEnds) {
  std::vector<double> cubic;
  for (int k = 0; k < 40; ++k) {
    const double t = 0.1 * k;
    cubic.push_back(1 + 2 * t - 3 * t * t + 0.5 * t * t * t);
  }
  const Motion motion = savitzky_golay(cubic, 0.1, 3);
  for (int k = 0; k < 40; ++k) {
    const double t = 0.1 * k;
    const auto at = static_cast<std::size_t>(k);
    EXPECT_NEAR(motion.position[at], cubic[at], 1e-9);
    EXPECT_NEAR(motion.rate[at], 2 - 6 * t + 1.5 * t * t, 1e-8);
    EXPECT_NEAR(motion.acceleration[at], -6 + 3 * t, 1e-6);
  }
}

TEST(Spline, IsReproducedByItsAccelerationIntegratedTwice) {
  constexpr double kPeriod_s = 0.01;
  const std::uint64_t seed = 4;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> any;
  std::vector<double> measured{0};
  for (double speed = 0.3; measured.size() < 300; speed += 0.02 * any(random))
    measured.push_back(measured.back() + kPeriod_s * speed);
  const Motion motion = spline(measured, kPeriod_s);
  double position = measured[0], speed = motion.rate[0];
  for (std::size_t k = 0; k + 1 < measured.size(); ++k) {
    ASSERT_NEAR(position, measured[k], 1e-9) << "seed " << seed << ", row " << k;
    ASSERT_NEAR(speed, motion.rate[k], 1e-7) << "seed " << seed << ", row " << k;
    const double a = motion.acceleration[k], b = motion.acceleration[k + 1];
    position += kPeriod_s * speed + kPeriod_s * kPeriod_s * (2 * a + b) / 6;
    speed += 0.5 * kPeriod_s * (a + b);
  }
}

}  // namespace
}  // namespace crane::diagnosis
