// Zones are added to and removed from the text of a rig file; all other text does not change.
#include "crane/configuration/zone_editor.hpp"

#include <gmock/gmock.h>

#include "../recording/temporary_directory.hpp"
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
              HasSubstr("touches the space of a load at rest at the position of [start]"));
}

/// A library for regular expressions recursed once for each character of a line.
TEST(ZoneEditor, AcceptsALongComment) {
  const auto text = "# " + std::string(60'000, 'x') + "\n" + kTowerText;
  const auto with = with_zone(text, "rig.toml", mast("mast"));
  EXPECT_EQ(without_zone(with, "rig.toml", "mast"), text);
}

TEST(ZoneEditor, FindsTheHeadersThatTomlPermits) {
  const std::string body =
      "name = \"a\"\nshape = \"cylinder\"\nposition_x_m = -0.8\nradius_m = 0.2\ntop_m = 3\n";
  for (const char* header : {"[[zone]]", "  [[ zone ]]  # comment", "\t[[zone ]]"})
    EXPECT_EQ(without_zone(kTowerText + header + "\n" + body, "rig.toml", "a"), kTowerText) << header;
}

/// A rig file in one directory, and its text for another one.
class Moved : public testing::Test {
 protected:
  Moved() {
    std::filesystem::create_directories(directory / "rigs");
    std::filesystem::create_directories(directory / "mine");
    recording::put_contents(directory / "rigs/base.toml", kTowerText);
  }
  [[nodiscard]] std::string moved_text(const std::string& text) const {
    return moved(text, directory / "rigs/my.toml", directory / "mine/my.toml");
  }
  recording::TemporaryDirectory directory;
};

TEST_F(Moved, ARelativeBaseIsTheSameFileAtTheNewPlace) {
  for (const char* extends : {"extends = \"base.toml\"", "# first\nextends='./base.toml' # the tower",
                              "extends   =   \"../rigs/base.toml\""}) {
    const auto text = std::string{extends} + "\nname = \"mine\"  # of us\n";
    const auto there = moved_text(text);
    EXPECT_THAT(there, HasSubstr((directory / "rigs/base.toml").string())) << extends;
    EXPECT_THAT(there, HasSubstr("name = \"mine\"  # of us\n"));
    auto read = parse_rig(there, (directory / "mine/my.toml").string());
    read.path = (directory / "rigs/my.toml").string();
    EXPECT_EQ(read, parse_rig(text, read.path));
  }
}

TEST_F(Moved, AnotherBaseAtTheNewPlaceIsNotUsed) {
  recording::put_contents(directory / "mine/base.toml",
                          kTowerText.substr(0, kTowerText.find("\n[clearance]")) + "\n");
  const auto there = moved_text("extends = \"base.toml\"\n");
  EXPECT_EQ(parse_rig(there, (directory / "mine/my.toml").string()).clearance.load_radius_m, 0.1);
}

TEST_F(Moved, TextIsUnchangedInItsDirectoryAndWithoutARelativeBase) {
  const std::string relative = "extends = \"base.toml\"\n";
  EXPECT_EQ(moved(relative, directory / "rigs/my.toml", directory / "rigs/other.toml"), relative);
  EXPECT_EQ(moved_text(kTowerText), kTowerText);
}

TEST_F(Moved, ABaseThatCannotBeRewrittenIsRefused) {
  EXPECT_THAT(refusal([&] { return moved_text("extends = \"\"\"base.toml\"\"\"\n"); }),
              HasSubstr("write the file beside"));
}

}  // namespace
}  // namespace crane::configuration
