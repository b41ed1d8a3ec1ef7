/// Values that no motion explains are named with row and time, and left out or refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "crane/diagnosis/data.hpp"
#include "laboratory/strange_lab.hpp"

namespace crane::diagnosis {
namespace {

using testing::AllOf;
using testing::HasSubstr;

configuration::Rig broken_lab() { return configuration::load_rig(CRANE_RIGS "/gantry.toml"); }

recording::Table whole_file() { return strange::recorded(strange::moved({}, 12, strange::rich_command), {}); }

std::vector<double>& values_of(recording::Table& table, const std::string& name) {
  for (auto& column : table.columns)
    if (column.name == name) return column.values;
  throw std::invalid_argument(name);
}

std::string refusal_of(const recording::Table& table) {
  try {
    (void)load_run(table, broken_lab(), "broken.csv");
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

TEST(BrokenData, AnIntactFileHasNoNotes) {
  const Loaded loaded = load_run(whole_file(), broken_lab(), "broken.csv");
  EXPECT_TRUE(loaded.notes.empty()) << loaded.notes[0];
}

TEST(BrokenData, SpikesAreNamedWithRowAndTimeAndLeftOut) {
  auto table = whole_file();
  values_of(table, "swing_radial_rad")[400] = 1e7 * M_PI / 180;
  values_of(table, "trolley_position_m")[700] = -1e7;
  values_of(table, "trolley_position_m")[701] = -1e7;
  const Loaded loaded = load_run(table, broken_lab(), "broken.csv");
  ASSERT_EQ(loaded.runs.size(), 1U);
  ASSERT_GE(loaded.notes.size(), 2U);
  EXPECT_THAT(loaded.notes[0],
              AllOf(HasSubstr("trolley_position_m: spikes"), HasSubstr("row 701 to 702 at 7 s")));
  EXPECT_THAT(loaded.notes[1], AllOf(HasSubstr("swing_radial_rad: spikes"), HasSubstr("row 401 at 4 s")));
  EXPECT_FALSE(loaded.runs[0].is_measured(kRadialSwing, 400));
  EXPECT_TRUE(loaded.runs[0].is_measured(kTrolleyPosition, 400));
  EXPECT_FALSE(loaded.runs[0].is_measured(kTrolleyPosition, 701));
}

TEST(BrokenData, AColumnOfSpikesIsRefused) {
  auto table = whole_file();
  for (std::size_t k = 5; k < 1200; k += 10) values_of(table, "swing_radial_rad")[k] = 3e5;
  EXPECT_THAT(refusal_of(table), AllOf(HasSubstr("swing_radial_rad"), HasSubstr("are spikes")));
}

TEST(BrokenData, FrozenValuesInMotionAreLeftOut) {
  auto table = whole_file();
  auto& swing = values_of(table, "swing_radial_rad");
  std::size_t from = 500;  // fast part of the swing
  while (std::abs(swing[from + 1] - swing[from - 1]) < 0.004) ++from;
  for (std::size_t k = from; k < from + 77; ++k) swing[k] = swing[from];
  const Loaded loaded = load_run(table, broken_lab(), "broken.csv");
  ASSERT_FALSE(loaded.notes.empty());
  EXPECT_THAT(loaded.notes[0], AllOf(HasSubstr("swing_radial_rad: values that do not change while it moves"),
                                     HasSubstr("row " + std::to_string(from + 2))));
  EXPECT_FALSE(loaded.runs.at(0).is_measured(kRadialSwing, from + 20));
  EXPECT_TRUE(loaded.runs.at(0).is_measured(kTrolleyPosition, from + 20));
}

TEST(BrokenData, AnAxisAtRestIsNotFrozen) {
  const auto rest = [](double t) { return t < 4 ? 0.8 * std::sin(2 * M_PI * t / 4) : 0.0; };
  const auto table =
      strange::recorded(strange::moved({.drag_nspm = 60}, 12, rest), {.position_step_m = 1e-3});
  for (const std::string& note : load_run(table, broken_lab(), "broken.csv").notes)
    EXPECT_THAT(note, Not(HasSubstr("do not change")));
}

/// Dry friction holds the axis between two fast motions. The sensor is finer than the last step to rest.
TEST(BrokenData, AnAxisThatSticksBetweenTwoMotionsIsNotFrozen) {
  constexpr double kMotion_s = 0.5, kRest_s = 0.4, kCycle_s = 2 * kMotion_s + kRest_s, kStep_m = 1e-6;
  auto table = whole_file();
  auto& position = values_of(table, "trolley_position_m");
  for (std::size_t k = 0; k < position.size(); ++k) {
    const double time_s = 0.01 * static_cast<double>(k), phase_s = std::fmod(time_s, kCycle_s);
    const double braking_mps2 = 3 + 0.3 * std::sin(std::floor(time_s / kCycle_s));
    const double left_s = std::max({0.0, kMotion_s - phase_s, phase_s - kMotion_s - kRest_s});
    position[k] = std::round(-0.5 * braking_mps2 * left_s * left_s / kStep_m) * kStep_m;
  }
  for (const std::string& note : load_run(table, broken_lab(), "broken.csv").notes)
    EXPECT_THAT(note, Not(HasSubstr("do not change")));
}

TEST(BrokenData, AResetCounterCutsTheRunAndIsNamed) {
  auto table = whole_file();
  auto& position = values_of(table, "trolley_position_m");
  const double lost = position[600];
  for (std::size_t k = 600; k < position.size(); ++k) position[k] -= lost;
  const Loaded loaded = load_run(table, broken_lab(), "broken.csv");
  EXPECT_EQ(loaded.runs.size(), 2U);
  EXPECT_THAT(loaded.notes.at(0), AllOf(HasSubstr("jumps"), HasSubstr("row 601 at 6 s")));
}

TEST(BrokenData, MissingValuesAreNamedAndDoNotAffectOtherColumns) {
  auto table = whole_file();
  for (std::size_t k = 300; k < 330; ++k) values_of(table, "swing_radial_rad")[k] = std::nan("");
  const Loaded loaded = load_run(table, broken_lab(), "broken.csv");
  ASSERT_EQ(loaded.runs.size(), 1U);
  EXPECT_THAT(loaded.notes.at(0), AllOf(HasSubstr("30 rows lack a value"), HasSubstr("row 301 at 3 s")));
  EXPECT_TRUE(loaded.runs[0].is_measured(kTrolleyPosition, 310));
}

TEST(BrokenData, ASwingOfTheWrongSignIsRefused) {
  auto table = whole_file();
  for (double& swing : values_of(table, "swing_radial_rad")) swing = -swing;
  EXPECT_THAT(refusal_of(table),
              AllOf(HasSubstr("swing_radial_rad"), HasSubstr("change the sign in the mapping")));
}

/// A tower whose jib slews in both directions: L tangential'' + g tangential = -(x slew'' + 2 x' slew').
recording::Table turning_tower(double sign) {
  const configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
  const double length_m = rig.start.position[plant::kHoist], gravity_mps2 = rig.plant.gravity_mps2;
  recording::Table table;
  for (const char* name : {"time_s", "trolley_voltage_v", "slew_voltage_v", "trolley_position_m",
                           "slew_angle_rad", "swing_radial_rad", "swing_tangential_rad"})
    table.columns.push_back({name, {}});
  constexpr double kStep_s = 1e-3, kTrolley_m = 0.8, kTurn_rad = 0.4;
  double swing = 0, rate = 0;
  for (int k = 0; k < 60000; ++k) {
    const double t = k * kStep_s, slow = 0.9 * t, fast = 2.3 * t;
    const double slew_rad = kTurn_rad * (std::sin(slow) + 0.3 * std::sin(fast));
    const double acceleration = -kTurn_rad * (0.81 * std::sin(slow) + 0.3 * 5.29 * std::sin(fast));
    if (k % 10 == 0) {
      const double values[] = {
          t,        0.01 * std::sin(t),       std::sin(slow), kTrolley_m + 0.02 * std::sin(0.3 * t),
          slew_rad, 0.01 * std::sin(0.7 * t), sign * swing};
      for (std::size_t i = 0; i < std::size(values); ++i) table.columns[i].values.push_back(values[i]);
    }
    rate -= kStep_s * (gravity_mps2 * swing + kTrolley_m * acceleration) / length_m;
    swing += kStep_s * rate;
  }
  return table;
}

TEST(BrokenData, ATangentialSwingOfTheWrongSignIsRefused) {
  const configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
  EXPECT_NO_THROW((void)load_run(turning_tower(1), rig, "tower.csv"));
  try {
    (void)load_run(turning_tower(-1), rig, "tower.csv");
    FAIL() << "it was accepted";
  } catch (const DataError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("swing_tangential_rad"), HasSubstr("change the sign in the mapping")));
  }
}

TEST(BrokenData, AllProblemsAreNamedAtOnce) {
  auto table = whole_file();
  for (double& swing : values_of(table, "swing_radial_rad")) swing *= 4000;
  for (double& position : values_of(table, "trolley_position_m")) position *= 1000;
  for (double& volts : values_of(table, "trolley_voltage_v")) volts *= 1000;
  EXPECT_THAT(refusal_of(table), AllOf(HasSubstr("swing_radial_rad"), HasSubstr("trolley_position_m"),
                                       HasSubstr("trolley_voltage_v")));
}

TEST(BrokenData, ARepeatedTimeLosesThatRow) {
  auto table = whole_file();
  values_of(table, "time_s")[200] = values_of(table, "time_s")[199];
  const Loaded loaded = load_run(table, broken_lab(), "broken.csv");
  EXPECT_EQ(loaded.runs.size(), 1U);
  EXPECT_THAT(loaded.notes.at(0), HasSubstr("row 201"));
}

}  // namespace
}  // namespace crane::diagnosis
