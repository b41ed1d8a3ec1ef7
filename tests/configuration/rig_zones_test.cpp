// [[zone]] and [clearance] of a rig file.
#include <gmock/gmock.h>

#include <cmath>

#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::configuration {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

const std::string kZonedTower = std::string{CRANE_RIGS} + "/virginia_tech_tower.toml";
const std::string kMargins = "\n[clearance]\nload_radius_m = 0.1\nsuspension_height_m = 2\n";

std::string box(const std::string& name, const std::string& more = "") {
  return "\n[[zone]]\nname = \"" + name + "\"\nshape = \"box\"\nposition_x_m = 0.9\nposition_y_m = 0.9\n" +
         "size_x_m = 0.2\nsize_y_m = 0.3\ntop_m = 1.5\n" + more;
}

std::vector<std::string> text_problems(const std::string& text) {
  try {
    (void)parse_rig(text, std::string{CRANE_RIGS} + "/rig.toml");
    return {};
  } catch (const ConfigurationError& error) {
    return error.problems();
  }
}

std::vector<std::string> zone_problems(const std::string& added, const std::string& rig = kZonedTower) {
  return text_problems(file_text(rig) + added);
}

TEST(RigZones, AreAtMostAHundred) {
  std::string hundred;
  for (int i = 0; i < 100; ++i) hundred += box("silo " + std::to_string(i));
  EXPECT_THAT(zone_problems(kMargins + hundred), testing::IsEmpty());
  const auto problems = zone_problems(kMargins + hundred + box("one more"));
  ASSERT_THAT(problems, SizeIs(1));
  EXPECT_THAT(problems[0], HasSubstr("has 101 tables: must be at most 100"));
}

TEST(RigZones, AreReadAndWrittenBack) {
  const auto rig = parse_rig(file_text(kZonedTower) + kMargins + box("silo") +
                                 "\n[[zone]]\nname = \"mast\"\nshape = \"cylinder\"\nposition_x_m = -0.8\n"
                                 "radius_m = 0.2\nbottom_m = 0.5\ntop_m = 3\n",
                             "rig.toml");
  ASSERT_THAT(rig.zones, SizeIs(2));
  EXPECT_EQ(rig.zones[0].name, "silo");
  EXPECT_EQ(rig.zones[0].size_y_m, 0.3);
  EXPECT_EQ(rig.zones[1].shape, control::ZoneShape::cylinder);
  EXPECT_EQ(rig.clearance.suspension_height_m, 2);
  EXPECT_TRUE(parse_rig(to_toml(rig), "rig.toml") == rig);
  auto other = rig;
  other.zones[1].radius_m = 0.3;
  EXPECT_FALSE(other == rig);
}

TEST(RigZones, OfARigWithoutThemNeedNoRadiusOfTheLoad) { EXPECT_THAT(zone_problems(""), SizeIs(0)); }

TEST(RigZones, NameAllContradictionsAtOnce) {
  const auto found = zone_problems(
      "\n[[zone]]\nname = \"silo\"\nshape = \"box\"\nposition_x_m = 0.9\nposition_y_m = 0.9\nsize_x_m = -1\n"
      "size_y_m = 0.2\ntop_m = 1\n"
      "\n[[zone]]\nname = \"silo\"\nshape = \"cylinder\"\nposition_x_m = 30\nradius_m = 0.2\ntop_m = 1\n"
      "\n[[zone]]\nname = \"low\"\nshape = \"cylinder\"\nposition_x_m = 0.9\nradius_m = 0.2\nbottom_m = "
      "1\ntop_m = 0\n"
      "\n[[zone]]\nname = \"\"\nshape = \"pyramid\"\nposition_x_m = 0.9\ntop_m = 1\n");
  std::string all;
  for (const auto& problem : found) all += problem + '\n';
  for (const char* part : {"size_x_m = -1: must be in [0, 1000]", "two zones have this name",
                           "top_m = 0: must be above bottom_m", "name = \"\": must not be empty", "pyramid",
                           "load_radius_m", "zone silo is outside of the space that the load can reach"})
    EXPECT_THAT(all, HasSubstr(part));
}

TEST(RigZones, HaveTheSizesOfTheirShapeOnly) {
  EXPECT_THAT(zone_problems(kMargins + box("silo", "radius_m = 0.2\n")),
              testing::ElementsAre(HasSubstr("radius_m = 0.2: must not be given: the shape is a box")));
  EXPECT_THAT(zone_problems(kMargins + "\n[[zone]]\nname = \"a\"\nshape = \"cylinder\"\nposition_x_m = "
                                       "0.9\nposition_y_m = 0.9\ntop_m = 1.5\n"),
              testing::ElementsAre(HasSubstr("radius_m: must be above 0: the shape is a cylinder")));
}

TEST(RigZones, MustNotContainTheStart) {
  EXPECT_THAT(zone_problems(kMargins + "\n[[zone]]\nname = \"a\"\nshape = \"cylinder\"\nposition_x_m = "
                                       "0.4\nradius_m = 0.1\ntop_m = 1.5\n"),
              testing::ElementsAre(
                  HasSubstr("zone a touches the space of a load at rest at the position of [start]")));
}

TEST(RigZones, BelowTheLoadAreOutOfReach) {
  EXPECT_THAT(zone_problems("\n[clearance]\nload_radius_m = 0.1\nsuspension_height_m = 20\n" + box("low")),
              testing::ElementsAre(HasSubstr("outside of the space that the load can reach")));
}

TEST(RigZones, MustNotContainAHomingPosition) {
  const auto found = zone_problems(
      "\n[clearance]\nload_radius_m = 0.05\nwind_mps2 = 0\n\n[[zone]]\nname = \"foot\"\nshape = "
      "\"cylinder\"\nposition_x_m = 0.05\n"
      "radius_m = 0.01\nbottom_m = -2\ntop_m = -0.5\n",
      std::string{CRANE_RIGS} + "/homing_servo_to_go.toml");
  ASSERT_THAT(found, testing::Not(testing::IsEmpty()));
  EXPECT_THAT(found.front(),
              HasSubstr("touches the space of a load at rest at the homing position of the trolley"));
}

TEST(RigZones, MustNotContainThePositionAfterHomingAllAxes) {
  std::string text = file_text(std::string{CRANE_RIGS} + "/homing_servo_to_go.toml");
  const std::string low = "mark = \"limit_low\"";
  text.replace(text.find(low), low.size(), "mark = \"limit_high\"");  // of the trolley
  const auto rig = parse_rig(text, std::string{CRANE_RIGS} + "/rig.toml");
  const double trolley_m = rig.drives[plant::kTrolley].homing.position,
               slew_rad = rig.drives[plant::kSlew].homing.position;
  ASSERT_EQ(trolley_m, rig.drives[plant::kTrolley].high_limit);
  const auto post_at = [&](double angle_rad) {
    return "\n[clearance]\nload_radius_m = 0.05\nwind_mps2 = 0\n\n[[zone]]\nname = \"post\"\n"
           "shape = \"cylinder\"\nposition_x_m = " +
           std::to_string(trolley_m * std::cos(angle_rad)) +
           "\nposition_y_m = " + std::to_string(trolley_m * std::sin(angle_rad)) +
           "\nradius_m = 0.02\nbottom_m = -2\ntop_m = 0\n";
  };
  EXPECT_THAT(text_problems(text + post_at(slew_rad)),
              testing::ElementsAre(HasSubstr(
                  "zone post touches the space of a load at rest at the position after homing all axes")));
  EXPECT_THAT(text_problems(text + post_at(slew_rad - 0.2)), testing::IsEmpty());
  const std::string back_off = "back_off_rad = 0.03";  // beyond the mark, in positive direction
  text.replace(text.find(back_off), back_off.size(), "back_off_rad = 0.2");
  EXPECT_THAT(text_problems(text + post_at(slew_rad + 0.2)),
              testing::ElementsAre(HasSubstr(
                  "zone post touches the space of a load at rest at the position after homing all axes")))
      << "the axes rest beyond their marks";
}

TEST(RigZones, NeedASwingingLoad) {
  EXPECT_THAT(zone_problems(kMargins + box("silo"), std::string{CRANE_RIGS} + "/drive_axis.toml"),
              testing::Contains(HasSubstr("zones need a tower or a gantry")));
  EXPECT_THAT(zone_problems(kMargins + box("silo"), std::string{CRANE_RIGS} + "/gantry.toml"),
              testing::Contains(HasSubstr("position_y_m = 0.9: must be 0: a gantry moves along x only")));
}

}  // namespace
}  // namespace crane::configuration
