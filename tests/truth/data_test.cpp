/// Data that the tests and benchmarks of the diagnosis receive.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "truth/truth.hpp"

namespace truth {
namespace {

using testing::HasSubstr;

Case short_case(const std::string& rig, std::vector<Hidden> effects, std::uint64_t seed = 3) {
  Case c;
  c.rig = rig;
  c.effects = std::move(effects);
  c.seed = seed;
  c.training_runs = {rig == "pendulum" ? "swing" : "rich"};
  c.test_runs = {};
  c.seconds = 4;
  return c;
}

std::string bytes(const Case& c) { return csv(generate(c).training.at(0)); }

TEST(TruthData, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const Case c = short_case("tower", {{"backlash", 1, "slew"}, {"command_delay", 1, "trolley"}});
  Case other = c;
  other.seed = 4;
  EXPECT_TRUE(bytes(c) == bytes(c));
  EXPECT_TRUE(bytes(c) != bytes(other));
}

TEST(TruthData, IsTheBaseDataWhenAnEffectIsSwitchedOff) {
  for (const std::string rig : {"tower", "gantry", "drive_axis", "pendulum"}) {
    Case base = short_case(rig, {});
    base.seconds = 0.3;
    const std::string text = bytes(base);
    int possible = 0;
    for (const EffectKind& kind : effect_kinds()) {
      Case off = base;
      off.effects = {{kind.name, 0, ""}};
      try {
        EXPECT_TRUE(bytes(off) == text) << rig << " " << kind.name;
        ++possible;
      } catch (const std::invalid_argument&) {  // this rig cannot have the effect
      }
    }
    EXPECT_GE(possible, 12) << rig;
  }
}

TEST(TruthData, DiffersFromTheBaseDataWithAnyEffect) {
  const std::string base = bytes(short_case("tower", {}));
  for (const EffectKind& kind : effect_kinds())
    EXPECT_TRUE(bytes(short_case("tower", {{kind.name, 1, ""}})) != base) << kind.name;
}

TEST(TruthData, ContainsTheColumnsOfTheRig) {
  using testing::ElementsAre;
  EXPECT_THAT(generate(short_case("tower", {})).training[0].columns,
              ElementsAre("time_s", "trolley_voltage_v", "slew_voltage_v", "trolley_position_m",
                          "slew_angle_rad", "swing_radial_rad", "swing_tangential_rad", "cable_length_m"));
  EXPECT_THAT(generate(short_case("drive_axis", {})).training[0].columns,
              ElementsAre("time_s", "trolley_voltage_v", "trolley_position_m"));
  EXPECT_THAT(generate(short_case("pendulum", {})).training[0].columns,
              ElementsAre("time_s", "swing_radial_rad", "swing_tangential_rad", "cable_length_m"));
}

TEST(TruthData, RunsEveryMotionOfTheMenuInsideTheRig) {
  Case c;
  c.training_runs = run_kinds();
  c.test_runs = {};
  c.seconds = 20;
  for (const truth::Run& run : generate(c).training) {
    EXPECT_GE(run.rows.size(), 2000U);
    for (const auto& row : run.rows) {
      ASSERT_GT(row[3], 0.05) << run.kind;
      ASSERT_LT(row[3], 1.45) << run.kind;
      ASSERT_LT(std::abs(row[5]), 0.7) << run.kind;
      ASSERT_LT(std::abs(row[6]), 0.7) << run.kind;
    }
  }
}

TEST(TruthData, AppliesTheCommandOfARowFromThatRowOn) {
  Case c = short_case("gantry", {});
  c.disturbance = 0;
  c.sensor_noise = false;
  const truth::Run run = generate(c).training[0];
  // x'' = K V at rest: the position moves within the tick that follows the first voltage, by K V T^2 / 2.
  std::size_t k = 0;
  while (run.rows[k][1] == 0) ++k;
  EXPECT_NEAR(run.rows[k + 1][2] - run.rows[k][2], 0.5 * 1.2 * run.rows[k][1] * 1e-4, 1e-9);
}

TEST(TruthData, SealsTheAnswerWithItsNumbers) {
  const Data data = generate(short_case("tower", {{"command_delay", 2, "slew"}, {"magnetic_detent", 1, ""}}));
  const auto json = nlohmann::json::parse(answer_json(data));
  EXPECT_EQ(json["effects"][0]["name"], "command_delay");
  EXPECT_EQ(json["effects"][0]["axis"], "slew");
  EXPECT_EQ(json["effects"][0]["in_library"], true);
  EXPECT_NEAR(json["effects"][0]["parameters"]["delay_s"]["value"].get<double>(), 0.07, 1e-12);
  EXPECT_EQ(json["effects"][1]["in_library"], false);
}

TEST(TruthData, WritesItsFiles) {
  const auto directory = std::filesystem::path{testing::TempDir()} / "crane_truth_writes_its_files";
  const Data data = generate(short_case("tower", {}));
  write(data, directory);
  std::ifstream file{directory / "train_1.csv", std::ios::binary};
  const std::string text{std::istreambuf_iterator<char>{file}, {}};
  EXPECT_TRUE(text == csv(data.training[0]));
  EXPECT_TRUE(std::filesystem::exists(directory / "answer.json"));
  std::filesystem::remove_all(directory);
}

/// An effect must exceed the disturbance by the factor two, in at least one column of one run. A much larger
/// amplitude would prove nothing about the nominal amplitude.
TEST(TruthData, ShowsAnEffectAboveTheDisturbance) {
  Case c = short_case("tower", {{"coulomb_friction", 1, "trolley"}});
  c.seconds = 20;
  EXPECT_GT(effect_size(c).ratio, 2);
  c.effects[0].amplitude = 0;
  EXPECT_EQ(effect_size(c).ratio, 0);
}

std::string refusal(const Case& c) {
  try {
    (void)generate(c);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(TruthData, NamesInvalidInput) {
  EXPECT_THAT(refusal(short_case("ship", {})), HasSubstr("rig = ship"));
  EXPECT_THAT(refusal(short_case("tower", {{"rust", 1, ""}})), HasSubstr("effect = rust"));
  EXPECT_THAT(refusal(short_case("gantry", {{"backlash", 1, "slew"}})), HasSubstr("axis = slew"));
  EXPECT_THAT(refusal(short_case("drive_axis", {{"payload_mass", 1, ""}})), HasSubstr("cannot have it"));
  EXPECT_THAT(refusal(short_case("tower", {{"backlash", -1, ""}})), HasSubstr(">= 0"));
  Case c = short_case("gantry", {});
  c.training_runs = {"slew_180"};
  EXPECT_THAT(refusal(c), HasSubstr("no slew drive"));
  c.training_runs = {"waltz"};
  EXPECT_THAT(refusal(c), HasSubstr("run = waltz"));
}

}  // namespace
}  // namespace truth
