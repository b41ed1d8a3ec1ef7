/// Subsets of the columns; mappings of rows and commands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "crane/diagnosis/diagnosis.hpp"
#include "crane/diagnosis/mapping.hpp"
#include "laboratory/strange_lab.hpp"

namespace crane::diagnosis {
namespace {

using testing::AllOf;
using testing::HasSubstr;

configuration::Rig subset_rig(const std::string& name = "gantry") {
  return configuration::load_rig(std::string{CRANE_RIGS} + "/" + name + ".toml");
}

recording::Table without(recording::Table table, const std::vector<std::string>& columns) {
  for (const std::string& name : columns)
    std::erase_if(table.columns, [&](const auto& c) { return c.name == name; });
  return table;
}

std::string refused(const recording::Table& table) {
  try {
    (void)load_run(table, subset_rig(), "part.csv");
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

recording::Table measured_with(std::uint64_t seed, double cable_m, const strange::Recording& how = {}) {
  const auto command = [=](double t) { return strange::rich_command(t + 7.0 * static_cast<double>(seed)); };
  strange::Recording lab = how;
  lab.seed = seed;
  return strange::recorded(strange::moved({.cable_m = cable_m}, 15, command), lab);
}

TEST(SubsetOfColumns, ALoadWithTheMeasuredMotionOfItsSupportNeedsNoCommand) {
  const auto load_only = [](std::uint64_t seed) {
    const auto table = without(measured_with(seed, 1.62), {"trolley_voltage_v"});
    return load_run(table, subset_rig(), "load_" + std::to_string(seed) + ".csv");
  };
  EXPECT_THAT(load_only(1).notes.at(0), HasSubstr("the load alone is compared"));
  Request request;
  request.most_effects = 1;
  const Diagnosis found =
      diagnose(subset_rig(), {load_only(1).runs.at(0), load_only(2).runs.at(0)}, load_only(3).runs, request);
  EXPECT_EQ(found.verdict, Verdict::parameter) << found.sentence;
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes[0].name, "cable_length");
  EXPECT_NEAR(found.causes[0].parameters.at(0).value, 0.12, 0.01);
  EXPECT_FALSE(found.held_out.baseline_rms.contains("trolley_position_m"));
}

/// The rig file of a pendulum states no drive; the measured position of its support is used all the same.
TEST(SubsetOfColumns, APendulumMayHangBelowASupportThatIsMovedByHand) {
  configuration::Rig pendulum = subset_rig("pendulum");
  const configuration::Rig gantry = subset_rig();
  pendulum.plant.load_mass_kg = gantry.plant.load_mass_kg;
  pendulum.start.position[plant::kHoist] = gantry.start.position[plant::kHoist];
  const auto moved_by_hand = [&](std::uint64_t seed) {
    const auto table = without(measured_with(seed, 1.62), {"trolley_voltage_v"});
    return load_run(table, pendulum, "hand_" + std::to_string(seed) + ".csv");
  };
  EXPECT_THAT(moved_by_hand(1).notes.at(0), HasSubstr("the load alone is compared"));
  Request request;
  request.most_effects = 1;
  const Diagnosis found = diagnose(pendulum, {moved_by_hand(1).runs.at(0), moved_by_hand(2).runs.at(0)},
                                   moved_by_hand(3).runs, request);
  EXPECT_EQ(found.verdict, Verdict::parameter) << found.sentence;
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes[0].name, "cable_length");
  EXPECT_NEAR(found.causes[0].parameters.at(0).value, 0.12, 0.01);
}

TEST(SubsetOfColumns, AMotionOfAnAxisThatTheRigFileDoesNotDescribeIsRefused) {
  recording::Table table = without(measured_with(1, 1.5), {"slew_angle_rad"});
  std::vector<double> turning = *table.find("trolley_position_m");
  table.columns.push_back({"slew_angle_rad", turning});
  EXPECT_THAT(refused(table), AllOf(HasSubstr("slew_angle_rad"), HasSubstr("no such axis")));
  table.columns.back().values.assign(turning.size(), 0.0);
  EXPECT_EQ(refused(table), "");
  table = without(std::move(table), {"slew_angle_rad", "swing_tangential_rad"});
  table.columns.push_back({"swing_tangential_rad", *table.find("swing_radial_rad")});
  EXPECT_THAT(load_run(table, subset_rig(), "plane.csv").notes,
              testing::Contains(HasSubstr("swing_tangential_rad is not compared")));
}

/// No cause of the library explains an intermittent friction.
TEST(RubbingDrive, IsNotNamedCorrectByTheVerdict) {
  const auto rubbed = [](std::uint64_t seed) {
    const auto command = [=](double t) { return strange::rich_command(t + 7.0 * static_cast<double>(seed)); };
    strange::Recording lab;
    lab.seed = seed;
    const auto table = strange::recorded(strange::moved({.rub_n = 15}, 15, command), lab);
    return load_run(table, subset_rig(), "rubbed_" + std::to_string(seed) + ".csv").runs.at(0);
  };
  Request request;
  request.most_effects = 1;
  const Diagnosis found = diagnose(subset_rig(), {rubbed(1), rubbed(2)}, {rubbed(3)}, request);
  EXPECT_EQ(found.verdict, Verdict::unknown) << found.sentence;
}

TEST(SubsetOfColumns, ADriveAloneIsCompared) {
  const auto loaded =
      load_run(without(measured_with(1, 1.5), {"swing_radial_rad"}), subset_rig(), "drive.csv");
  EXPECT_FALSE(loaded.runs.at(0).has(kRadialSwing));
  EXPECT_TRUE(loaded.runs.at(0).has(kTrolleyPosition));
}

TEST(SubsetOfColumns, ASupportAtRestMayBeAConstantOfTheMapping) {
  const auto table = without(strange::recorded(strange::moved(
                                                   {}, 12, [](double) { return 0.0; }, 0.2),
                                               {}),
                             {"trolley_voltage_v", "trolley_position_m"});
  EXPECT_THAT(refused(table), HasSubstr("a radial swing needs the measured position of the trolley"));
  const auto mapping = parse_mapping("[columns]\ntrolley_position_m = { value = 1.0 }\n", "rest.toml");
  const Loaded loaded = load_run(canonical(table, mapping, "rest.csv"), subset_rig(), "rest.csv");
  ASSERT_EQ(loaded.runs.size(), 1U);
  EXPECT_TRUE(loaded.runs[0].has(kRadialSwing));
}

/// A rotary pendulum is a tower crane whose trolley stands still.
recording::Table rotary_arm(const std::function<double(int)>& trolley_m) {
  std::string text = "time_s,slew_voltage_v,slew_angle_rad,swing_tangential_rad,trolley_position_m\n";
  for (int row = 0; row < 400; ++row) {
    const double t = 0.01 * row;
    text += std::to_string(t) + "," + std::to_string(2 * std::sin(3 * t)) + "," +
            std::to_string(0.2 * std::sin(3 * t)) + "," + std::to_string(0.05 * std::sin(5 * t)) + "," +
            std::to_string(trolley_m(row)) + "\n";
  }
  return recording::parse_csv(text, "arm.csv");
}

TEST(SubsetOfColumns, AnAxisAtRestNeedsNoCommandBesideACommandedAxis) {
  const auto tower = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
  const Loaded loaded = load_run(rotary_arm([](int) { return 0.6; }), tower, "arm.csv");
  ASSERT_EQ(loaded.runs.size(), 1U);
  EXPECT_TRUE(loaded.runs[0].commanded[kSlewAngle]);
  EXPECT_FALSE(loaded.runs[0].commanded[kTrolleyPosition]);
  EXPECT_THROW((void)load_run(rotary_arm([](int row) { return row < 399 ? 0.6 : 0.61; }), tower, "arm.csv"),
               DataError)
      << "a moving trolley";
}

TEST(SubsetOfColumns, AnAxisAtRestMayFlickerBetweenNeighbouringCounts) {
  const auto tower = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
  const double count_m = 1 / tower.encoders[plant::kTrolley].counts_per_unit;
  const auto flicker = [&](double counts) {
    return rotary_arm([=](int row) { return 0.6 + (row % 7 == 3 ? counts * count_m : 0); });
  };
  const Loaded loaded = load_run(flicker(1), tower, "arm.csv");
  ASSERT_EQ(loaded.runs.size(), 1U);
  EXPECT_THAT(loaded.notes, testing::Contains(HasSubstr("stays within 2 counts")));
  for (const double measured_m : loaded.runs[0].measured[kTrolleyPosition])
    EXPECT_NEAR(measured_m, 0.6, 1e-6) << "no motion of the support";
  EXPECT_THROW((void)load_run(flicker(3), tower, "arm.csv"), DataError);
}

TEST(SubsetOfColumns, AMotionWithoutCommandAndSwingIsRefused) {
  EXPECT_THAT(refused(without(measured_with(1, 1.5), {"trolley_voltage_v", "swing_radial_rad"})),
              HasSubstr("add this command, or a swing angle that the motion excites"));
}

TEST(SubsetOfColumns, RunsWithDifferentColumnsAreRefused) {
  const auto whole = load_run(measured_with(1, 1.5), subset_rig(), "whole.csv");
  const auto part = load_run(without(measured_with(2, 1.5), {"swing_radial_rad"}), subset_rig(), "part.csv");
  try {
    (void)diagnose(subset_rig(), {whole.runs.at(0)}, {part.runs.at(0)});
    FAIL() << "accepted";
  } catch (const DataError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("part.csv: swing_radial_rad: missing"),
                                    HasSubstr("whole.csv has this column")));
  }
}

TEST(MappingOfRows, ColumnsMultiplyEachOtherRowByRow) {
  const auto table = recording::parse_csv("t,duty,supply\n0,0.5,7\n1,-0.25,8\n", "run.csv");
  const auto mapping = parse_mapping(
      "[columns]\ntime_s = { column = \"t\" }\n"
      "slew_voltage_v = { column = \"duty\", times = [\"supply\"], factor = 2, sign = -1 }\n",
      "duty.toml");
  EXPECT_THAT(*canonical(table, mapping, "run.csv").find("slew_voltage_v"), testing::ElementsAre(-7, 4));
}

TEST(MappingOfRows, ACommandMayBeACurrentOrATorque) {
  const auto table = recording::parse_csv("time_s,current\n0,3\n", "run.csv");
  const auto mapping =
      parse_mapping("[columns]\ntrolley_voltage_v = { column = \"current\", unit = \"A\", per_volt = 0.5 }\n",
                    "current.toml");
  EXPECT_THAT(*canonical(table, mapping, "run.csv").find("trolley_voltage_v"), testing::ElementsAre(6));
}

TEST(MappingOfRows, TimesStretchesAndAnEnableColumnSelectRows) {
  const auto table = recording::parse_csv("time_s,on\n0,1\n1,1\n2,0\n3,1\n4,1\n5,1\n", "run.csv");
  const auto chosen = [&](const std::string& text) {
    return canonical(table, parse_mapping("[columns]\n" + text, "rows.toml"), "folder/run.csv");
  };
  EXPECT_THAT(*chosen("[enable]\ncolumn = \"on\"\n").find("time_s"), testing::ElementsAre(0, 1, 3, 4, 5));
  EXPECT_THAT(*chosen("[enable]\ncolumn = \"on\"\n").find(kStretchColumn),
              testing::ElementsAre(1, 1, 2, 2, 2));
  EXPECT_THAT(*chosen("[stretches]\n\"run.csv\" = [0, 0.5, 4, 9]\n").find("time_s"),
              testing::ElementsAre(0, 4, 5));
  EXPECT_THAT(*chosen("[stretches]\n\"other.csv\" = [0, 0.5]\n").find("time_s"),
              testing::ElementsAre(0, 1, 2, 3, 4, 5));
  const auto mapping = parse_mapping("from_s = 1\nto_s = 3\n[columns]\n", "rows.toml");
  EXPECT_THAT(*canonical(table, mapping, "run.csv").find("time_s"), testing::ElementsAre(1, 2, 3));
}

TEST(MappingOfRows, StretchesAreRunsAndRunsHaveTheirOwnLoad) {
  const auto mapping = parse_mapping(
      "[columns]\n[stretches]\n\"lab.csv\" = [0, 5, 5.1, 12]\n[runs.\"lab.csv\"]\ncable_length_m = 0.9\n"
      "load_mass_kg = 3.5\n",
      "rows.toml");
  const Loaded loaded =
      load_run(canonical(measured_with(1, 1.5), mapping, "lab.csv"), subset_rig(), "lab.csv");
  ASSERT_EQ(loaded.runs.size(), 2U);
  EXPECT_NEAR(loaded.runs[1].start_s, 5.1, 1e-9);
  EXPECT_EQ(loaded.runs[0].cable_m.at(0), 0.9);
  EXPECT_EQ(loaded.runs[0].load_mass_kg, 3.5);
}

TEST(MappingOfRows, ProblemsAreNamedWithFileLineAndRule) {
  try {
    (void)parse_mapping(
        "from_s = 3\nto_s = 1\n[columns]\ntime_s = { value = 1 }\nslew_angle_rad = { column = \"a\", unit = "
        "\"A\", per_volt = 1 }\n"
        "[stretches]\n\"a.csv\" = [2, 1]\n[runs.\"a.csv\"]\nload_mass_kg = -1\n",
        "their.toml");
    FAIL() << "accepted";
  } catch (const configuration::ConfigurationError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("their.toml:2: to_s = 1: must be after from_s"),
                      HasSubstr("columns.time_s.value"), HasSubstr("is permitted for commands"),
                      HasSubstr("stretches.a.csv"), HasSubstr("load_mass_kg = -1: must be finite and > 0")));
  }
}

}  // namespace
}  // namespace crane::diagnosis
