// Rig files with problems: all problems are reported at once, each with its line.
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "crane/configuration/encoder_resolution.hpp"
#include "crane/configuration/realtime_period.hpp"
#include "rig_text.hpp"

namespace crane::configuration {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(RigFile, RefusesToExtendItselfOrAMissingFile) {
  const auto directory = std::filesystem::path(testing::TempDir()) / "extends";
  std::filesystem::create_directories(directory);
  std::ofstream(directory / "a.toml") << "extends = 'b.toml'\n";
  std::ofstream(directory / "b.toml") << "extends = 'a.toml'\n";
  try {
    (void)load_rig(directory / "a.toml");
    FAIL() << "accepted";
  } catch (const ConfigurationError& error) {
    EXPECT_THAT(error.problems(), ElementsAre((directory / "b.toml").string() +
                                              ":1: extends = \"a.toml\": must not lead back to this file"));
  }
  EXPECT_THAT(problems_of("extends = 'nowhere.toml'\n"), ElementsAre(testing::HasSubstr("must name a file")))
      << "what only the missing file could say is no problem of this one";
}

TEST(RigFile, RefusesAFuzzyTableThatCannotBeGenerated) {
  ChangedTower changed;
  changed.change("[controller]", "name = \"gain_scheduling_partial\"", "name = \"fuzzy_generated\"")
      .change("[controller]", "fuzzy_swing_rate = 1.5", "fuzzy_swing_rate = 100");
  EXPECT_THAT(problems_of(changed.text()),
              ElementsAre(testing::AllOf(testing::StartsWith(changed.line("[controller]", "name =")),
                                         testing::HasSubstr("no rule for (NB, NB)"))));
}

TEST(RigFile, RefusesAShaperWithoutALoad) {
  std::ifstream stream(kRigs / "drive_axis.toml");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_THAT(problems_of(text + "\n[controller]\nshaper = \"zv\"\n"),
              ElementsAre(testing::HasSubstr("must be none: a drive_axis carries no load")));
}

TEST(RigFile, ReportsSeveralProblemsAtOnceEachWithItsLine) {
  ChangedTower tower;
  tower.change("[plant]", "load_mass_kg = 2.0", "load_mas_kg = 2.0")
      .change("[drive.trolley]", "volt_limit_v = 10.0", "volt_limit_v = 12")
      .change("[encoder.slew]", "channel = 1", "channel = 0")
      .change("[start]", "slew_angle_rad = 0.0", "slew_angle_deg = 5");
  EXPECT_THAT(problems_of(tower.text()),
              ElementsAre(tower.line("[plant]", "load_mas_kg") +
                              "plant.load_mas_kg = 2: unknown key; did you mean load_mass_kg?",
                          tower.line("[drive.trolley]", "volt_limit_v") +
                              "drive.trolley.volt_limit_v = 12: must be in (0, 10]",
                          tower.line("[encoder.slew]", "channel") +
                              "encoder.slew.channel = 0: must be used once: another section has this channel",
                          tower.line("[start]", "slew_angle") +
                              "start.slew_angle_deg = 5: unit must be rad: slew_angle_rad"));
}

TEST(RigFile, RefusesAnEncoderThatIsTooCoarseForTheBrakeOrTooFineForItsCounter) {
  ChangedTower tower;
  tower.change("[encoder.trolley]", "counts_per_m = 629921.2598425197", "counts_per_m = 1")
      .change("[encoder.slew]", "counts_per_rad = 57295.77951308232", "counts_per_rad = 1e9");
  const auto problems = problems_of(tower.text());
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[0], tower.line("[encoder.trolley]", "counts_per_m") +
                             "encoder.trolley.counts_per_m = 1: must be at least 50: one count must not "
                             "exceed the permitted slip of the closed brake, 0.02 m");
  EXPECT_THAT(problems[1],
              testing::AllOf(testing::StartsWith(tower.line("[encoder.slew]", "counts_per_rad")),
                             testing::HasSubstr("must be below"), testing::HasSubstr("2^23 counts")));
}

/// The bounds themselves: the coarsest accepted encoder, and the finest at the largest speed of the trolley.
TEST(RigFile, AcceptsEncodersUpToTheBoundsOfBrakeAndCounter) {
  const auto rig = parse_rig(tower_text(), "rig.toml");
  const auto& trolley = rig.drives[plant::kTrolley];
  const double most = (1 << 23) / (trolley.max_speed * rig.period_s);
  const auto problems_with = [](double counts_per_m) {
    ChangedTower tower;
    tower.change("[encoder.trolley]", "counts_per_m = 629921.2598425197",
                 "counts_per_m = " + std::to_string(counts_per_m));
    return problems_of(tower.text());
  };
  EXPECT_THAT(problems_with(1 / trolley.brake_slip), IsEmpty());
  EXPECT_THAT(problems_with(0.99 / trolley.brake_slip), testing::SizeIs(1));
  EXPECT_THAT(problems_with(0.99 * most), IsEmpty());
  EXPECT_THAT(problems_with(1.01 * most), testing::SizeIs(1));
}

TEST(RigFile, OfAControlLoopIsRefusedIfAnEncoderHidesTheSpeedOfItsAxis) {
  auto rig = parse_rig(tower_text(), "rig.toml");
  const auto bound = [&](std::size_t axis) { return 10 / (rig.drives[axis].max_speed * rig.period_s); };
  for (const auto axis : {plant::kTrolley, plant::kSlew})
    rig.encoders[axis].counts_per_unit = 1.01 * bound(axis);
  EXPECT_NO_THROW(require_resolved_speeds(rig));
  for (const auto axis : {plant::kTrolley, plant::kSlew})
    rig.encoders[axis].counts_per_unit = 0.99 * bound(axis);
  try {
    require_resolved_speeds(rig);
    FAIL() << "accepted";
  } catch (const ConfigurationError& error) {
    EXPECT_THAT(error.problems(),
                ElementsAre(testing::StartsWith("rig.toml: encoder.trolley.counts_per_m = 660"),
                            testing::StartsWith("rig.toml: encoder.slew.counts_per_rad = ")));
  }
}

TEST(RigFile, RefusesInRealTimeAPeriodBelowOneMillisecond) {
  auto rig = parse_rig(tower_text(), "rig.toml");
  for (const double period_s : {0.01, 0.001}) {
    rig.period_s = period_s;
    EXPECT_NO_THROW(require_realtime_period(rig));
  }
  for (const double period_s : {0.00099, 1e-4, 1e-5}) {
    rig.period_s = period_s;
    try {
      require_realtime_period(rig);
      FAIL() << "accepted " << period_s;
    } catch (const ConfigurationError& error) {
      EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("rig.toml: period_s = "),
                                               testing::HasSubstr("must be at least 0.001 in real time")));
    }
  }
}

struct Corruption {
  const char *name, *section, *from, *to, *rule;
};

class CorruptedTower : public testing::TestWithParam<Corruption> {};

TEST_P(CorruptedTower, IsRefusedWithOneLineAndItsRule) {
  const auto& [name, section, from, to, rule] = GetParam();
  ChangedTower tower;
  tower.change(section, from, to);
  EXPECT_THAT(
      problems_of(tower.text()),
      ElementsAre(testing::AllOf(testing::StartsWith(tower.line(section, to)), testing::HasSubstr(rule))));
}

INSTANTIATE_TEST_SUITE_P(
    Rules, CorruptedTower,
    testing::Values(
        Corruption{"nan", "[plant]", "gravity_mps2 = 9.81", "gravity_mps2 = nan", "must be in [0.001, 100]"},
        Corruption{"inf", "[drive.slew]", "max_speed_radps = 3.5", "max_speed_radps = inf",
                   "must be finite and > 0"},
        Corruption{"wrong_type", "[plant]", "load_mass_kg = 2.0", "load_mass_kg = '2'", "must be a number"},
        Corruption{"unknown_kind", "name", "kind = \"tower\"", "kind = \"derrick\"",
                   "must be one of tower, gantry"},
        Corruption{"low_above_high", "[drive.hoist]", "low_limit_m = 0.3", "low_limit_m = 1.9",
                   "must be below high_limit_m"},
        Corruption{"margin_too_small", "[drive.trolley]", "soft_margin_m = 0.1", "soft_margin_m = 0.01",
                   "must be at least 0.0"},
        Corruption{"sign_zero", "[encoder.hoist]", "sign = 1", "sign = 0", "must be 1 or -1"},
        Corruption{"dac_twice", "[drive.slew]", "dac_channel = 1", "dac_channel = 0", "must be used once"},
        Corruption{"channel_8", "[encoder.slew]", "channel = 1", "channel = 8",
                   "must be an integer in [0, 7]"},
        Corruption{"filter_at_nyquist", "[sensing]", "swing_filter_ratio = 0.05", "swing_filter_ratio = 0.5",
                   "must be in [0, 0.5)"},
        Corruption{"filter_axis", "[sensing]", "filter_speed = [\"slew\"]", "filter_speed = [\"slow\"]",
                   "must name trolley, slew or hoist"},
        Corruption{"start_outside", "[start]", "trolley_position_m = 0.3", "trolley_position_m = 1.5",
                   "must be inside the limits"},
        Corruption{"reference_too_fast", "[drive.hoist]", "reference_speed_mps = 0.2",
                   "reference_speed_mps = 0.8", "must not exceed max_speed_mps"},
        Corruption{"unknown_controller", "[controller]", "name = \"gain_scheduling_partial\"",
                   "name = \"magic\"", "must be one of gain_scheduling_partial"},
        Corruption{"unknown_term", "[[model.terms]]", "name = \"drive_friction\"", "name = \"magnetism\"",
                   "must be one of"},
        Corruption{"term_parameter", "[[model.terms]]", "coulomb_positive_v = 0.9", "coulomb_positiv_v = 0.9",
                   "did you mean coulomb_positive_v?"},
        Corruption{"term_range", "[[model.terms]]", "coulomb_positive_v = 0.9", "coulomb_positive_v = -0.9",
                   "must be in [0, 10]"},
        Corruption{"term_axis", "[[model.terms]]", "axis = \"trolley\"", "axis = \"radial\"",
                   "must be one of trolley, slew, hoist"},
        Corruption{"fuzzy_gain", "[controller]", "fuzzy_gain = -90.0", "fuzzy_gain = 0", "must not be 0"},
        Corruption{"fuzzy_points", "[controller]", "fuzzy_point_b = 0.6666666666666666",
                   "fuzzy_point_b = 0.3", "must be at least fuzzy_point_a + 0.01"},
        Corruption{"fuzzy_swing", "[controller]", "fuzzy_swing_rad = 0.17453292519943295",
                   "fuzzy_swing_rad = 0", "must be in (0, 3.2]"},
        Corruption{"delay_2", "[controller]", "delayed_2_delay = 0.31", "delayed_2_delay = 2.5",
                   "must be in [0, 2]"},
        Corruption{"anti_swing", "[controller]", "anti_swing_derivative = 8.0", "anti_swing_derivative = 1e6",
                   "must be in [-100000, 100000]"},
        Corruption{"shaper", "[controller]", "shaper = \"none\"", "shaper = \"zvdd\"",
                   "must be one of none, zv, zvd, ei"},
        Corruption{"trajectory", "[controller]", "trajectory = \"bang_coast_bang\"", "trajectory = \"bang\"",
                   "must be one of bang_coast_bang, s_curve"},
        Corruption{"friction_holds", "[controller.friction.slew]", "stiction_positive_v = 0.7",
                   "stiction_positive_v = 10", "times factor must be below the volt_limit_v"},
        Corruption{"no_period", "name", "period_s = 0.01", "period_s = 0", "must be in ["},
        Corruption{"no_cable", "[drive.hoist]", "low_limit_m = 0.3", "low_limit_m = 0", "must be in ["},
        Corruption{"no_load", "[plant]", "load_mass_kg = 2.0", "load_mass_kg = -1", "must be in [0"},
        Corruption{"factor", "[controller.friction.slew]", "factor = 1.0", "factor = 2.0",
                   "must be in [0, 1.5]"},
        Corruption{"slew_limit_in_degrees", "[drive.slew]", "high_limit_rad = 3.490658503988659",
                   "high_limit_rad = 200", "must be at most 20 turns (125.7 rad) from 0: are these degrees?"},
        Corruption{"trolley_gain", "[plant]", "trolley_gain_mps2pv = 2.0", "trolley_gain_mps2pv = 1000",
                   "times volt_limit_v (10 V) must be at most 5000 m/s²"},
        Corruption{"slew_gain", "[plant]", "slew_gain_radps2pv = 1.14", "slew_gain_radps2pv = 1000",
                   "times volt_limit_v (10 V) must be at most 5000 rad/s²"},
        Corruption{"hoist_gain", "[plant]", "hoist_gain_mpspv = 0.05", "hoist_gain_mpspv = 1000",
                   "times volt_limit_v (10 V) must be at most 100 m/s"},
        Corruption{"believed_gain", "[controller]", "name = \"gain_scheduling_partial\"",
                   "believes.trolley_gain_mps2pv = 1000\nname = \"none\"",
                   "times volt_limit_v (10 V) must be at most 5000 m/s²"},
        Corruption{"brake", "[drive.slew]", "brake_deceleration_radps2 = 11.0",
                   "brake_deceleration_radps2 = 1e9", "must be at most 5000 rad/s²"},
        Corruption{"volt_rate", "[drive.hoist]", "volt_rate_limit_vps = 1000.0", "volt_rate_limit_vps = 0.01",
                   "must be at least 1.25 V/s"},
        Corruption{"tracking_gain", "[controller]", "tracking_derivative = 20.0",
                   "tracking_derivative = 1000.0", "would correct 5 times the error in one tick"},
        Corruption{"idle_lock", "[limits]", "idle_lock_s = 60.0", "idle_lock_s = 1e-9",
                   "must be at least 0.5 s"},
        Corruption{"slew_friction_unit", "[controller.friction.slew]", "viscous_positive_vsprad",
                   "viscous_positive_vspm", "unit must be vsprad"}),
    [](const auto& entry) { return std::string(entry.param.name); });

TEST(RigFile, RefusesASwingLimitBelowTwoCountsOfTheEncoder) {
  ChangedTower tower;
  tower.change("[encoder.swing_radial]", "counts_per_rad = 3819.718634205488", "counts_per_rad = 1");
  EXPECT_THAT(problems_of(tower.text()),
              ElementsAre(testing::AllOf(
                  testing::StartsWith(tower.line("[limits]", "swing_limit_rad")),
                  testing::HasSubstr("must be at least 2 rad, 2 counts of [encoder.swing_radial]"))));
}

/// drive_friction is the whole friction of a drive. The other terms are corrections, which may add up.
TEST(RigFile, RefusesASecondFrictionOfADrive) {
  const auto problems_with = [](const std::string& name, const std::string& axis) {
    ChangedTower tower;
    tower.change("[plant]", "[drive.trolley]",
                 "[[model.terms]]\nname = \"" + name + "\"\naxis = \"" + axis + "\"\n[drive.trolley]");
    return problems_of(tower.text());
  };
  EXPECT_THAT(
      problems_with("drive_friction", "trolley"),
      ElementsAre(testing::HasSubstr("must not be repeated: an earlier term has this name and axis")));
  EXPECT_THAT(problems_with("drive_friction", "hoist"), IsEmpty());
  EXPECT_THAT(problems_with("coulomb_friction", "trolley"), IsEmpty());
}

/// The controllers of a fast rig use gains that a slow rig cannot: the bound follows from the period.
TEST(RigFile, RefusesAGainThatDivergesAtThePeriodOfTheRig) {
  ChangedTower tower;
  tower.change("name", "period_s = 0.01", "period_s = 0.1")
      .change("[controller]", "hoist_proportional_ps = 2.0", "hoist_proportional_ps = 19.9");
  EXPECT_THAT(problems_of(tower.text()), testing::Not(testing::Contains(testing::HasSubstr("hoist_prop"))));
  tower.change("[controller]", "hoist_proportional_ps = 19.9", "hoist_proportional_ps = 20.9");
  EXPECT_THAT(problems_of(tower.text()),
              testing::Contains(testing::HasSubstr("the cable loop would correct 2.1 times the error")));
}

TEST(RigFile, ReportsAMissingSectionOnce) {
  EXPECT_THAT(problems_of("name = 'x'\nkind = 'tower'\n"),
              ElementsAre("rig.toml:1: drive: missing", "rig.toml:1: encoder: missing",
                          "rig.toml:1: plant: missing"));
}

TEST(RigFile, RefusesDrivesThatItsKindDoesNotHave) {
  ChangedTower tower;
  tower.change("name", "kind = \"tower\"", "kind = \"gantry\"");
  EXPECT_THAT(problems_of(tower.text()), testing::Contains(tower.line("[drive.slew]", "[drive.slew]") +
                                                           "drive.slew: a gantry has no slew drive"));
}

TEST(RigFile, NamesAFileThatCannotBeRead) {
  EXPECT_THROW((void)load_rig(kRigs / "nowhere.toml"), ConfigurationError);
  EXPECT_THROW((void)load_rig(kRigs), ConfigurationError);
}

}  // namespace
}  // namespace crane::configuration
