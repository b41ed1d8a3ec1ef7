// Zones are added to and removed from the text of a rig file; all other text does not change.
#include "crane/configuration/zone_editor.hpp"

#include <gmock/gmock.h>

#include "crane/configuration/extended_file.hpp"

namespace crane::configuration {
namespace {

using testing::HasSubstr;

const std::string kTowerText =
    file_text(std::string{CRANE_RIGS} + "/virginia_tech_tower.toml") +
    "\n[clearance]\nload_radius_m = 0.1  # with the sling\nsuspension_height_m = 2.0\n";

control::Zone mast(const std::string& name) {
  return {
      .name = name, .shape = control::ZoneShape::cylinder, .position_x_m = -0.8, .radius_m = 0.2, .top_m = 3};
}

std::string refusal(const std::function<std::string()>& edit) {
  try {
    (void)edit();
    return "";
  } catch (const ConfigurationError& error) {
    return error.what();
  }
}

TEST(ZoneEditor, AddsATableAndChangesNoOtherText) {
  const auto text = with_zone(kTowerText, "rig.toml", mast("mast"));
  EXPECT_EQ(text.substr(0, kTowerText.size()), kTowerText);
  EXPECT_EQ(parse_rig(text, "rig.toml").zones, std::vector{mast("mast")});
}

TEST(ZoneEditor, RemovesTheTableThatItAdded) {
  EXPECT_EQ(without_zone(with_zone(kTowerText, "rig.toml", mast("mast")), "rig.toml", "mast"), kTowerText);
}

TEST(ZoneEditor, KeepsCommentsAndOtherZones) {
  const auto one = with_zone(kTowerText, "rig.toml", mast("one")) + "# behind the first\n";
  const auto two =
      with_zone(one, "rig.toml", mast("two")) + "\n# last line\n[sensing]\nfilter_swing_angle = false\n";
  // The deployed file has a table [sensing]; a second one is a syntax error of the edited file.
  EXPECT_THAT(refusal([&] { return without_zone(two, "rig.toml", "one"); }), HasSubstr("rig.toml"));
  const auto both = with_zone(one, "rig.toml", mast("two")) + "# last line\n";
  const auto second = without_zone(both, "rig.toml", "one");
  EXPECT_EQ(parse_rig(second, "rig.toml").zones, std::vector{mast("two")});
  EXPECT_THAT(second, HasSubstr("# behind the first"));
  EXPECT_THAT(second, HasSubstr("# with the sling"));
  EXPECT_THAT(without_zone(second, "rig.toml", "two"), HasSubstr("# last line"));
}

TEST(ZoneEditor, RefusesASecondZoneOfTheSameNameAndUnknownNames) {
  const auto text = with_zone(kTowerText, "rig.toml", mast("mast"));
  EXPECT_THAT(refusal([&] { return with_zone(text, "rig.toml", mast("mast")); }),
              HasSubstr("there is a zone mast already"));
  EXPECT_THAT(refusal([&] { return without_zone(text, "rig.toml", "silo"); }), HasSubstr("no zone silo"));
}

TEST(ZoneEditor, RefusesAnInlineArray) {
  const auto text =
      "zone = [{name = \"a\", shape = \"cylinder\", position_x_m = -0.8, radius_m = 0.2, top_m = 3}]\n" +
      kTowerText;
  EXPECT_THAT(refusal([&] { return without_zone(text, "rig.toml", "a"); }), HasSubstr("by hand"));
  EXPECT_NE(refusal([&] { return with_zone(text, "rig.toml", mast("mast")); }), "");
}

TEST(ZoneEditor, RefusesAZoneThatContradictsTheRig) {
  auto zone = mast("mast");
  zone.position_x_m = 0.3;
  EXPECT_THAT(refusal([&] { return with_zone(kTowerText, "rig.toml", zone); }),
              HasSubstr("contains the position of [start]"));
}

}  // namespace
}  // namespace crane::configuration
