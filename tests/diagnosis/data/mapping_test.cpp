#include "crane/diagnosis/mapping.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names_of(const recording::Table& table) {
  std::vector<std::string> names;
  for (const auto& column : table.columns) names.push_back(column.name);
  return names;
}

std::string problems_of(const std::string& text) {
  try {
    (void)parse_mapping(text, "their.toml");
  } catch (const configuration::ConfigurationError& error) {
    return error.what();
  }
  return "";
}

TEST(Mapping, TurnsUnitsSignsAndZerosAndKeepsCanonicalColumns) {
  const auto mapping = parse_mapping(R"([columns]
swing_radial_rad = { column = "theta_deg", factor = 0.5, sign = -1, offset = 3 }
time_s = { column = "t_ms", factor = 0.001 }
)",
                                     "their.toml");
  const auto table =
      recording::parse_csv("theta_deg,other,t_ms,cable_length_m\n2,9,1000,0.7\n-4,9,2000,0.8\n", "run.csv");
  const auto result = canonical(table, mapping, "run.csv");
  EXPECT_THAT(names_of(result), ElementsAre("time_s", "swing_radial_rad", "cable_length_m"));
  EXPECT_THAT(*result.find("time_s"), ElementsAre(1, 2));
  EXPECT_THAT(*result.find("swing_radial_rad"), ElementsAre(3 - 0.5 * 2, 3 + 0.5 * 4));
  EXPECT_THAT(*result.find("cable_length_m"), ElementsAre(0.7, 0.8));
}

TEST(Mapping, UnwrapsAnAngle) {
  const auto mapping = parse_mapping(R"([columns]
slew_angle_rad = { column = "deg", factor = 0.5, sign = -1, offset = 7, wraps = 180 }
)",
                                     "their.toml");
  const auto table = recording::parse_csv("deg\n350\n359\n\n10\n350\n200\n30\n", "run.csv");
  const auto skipped = recording::parse_csv("deg,x\n350,0\n,0\n10,0\n", "run.csv");
  EXPECT_THAT(*canonical(table, mapping, "run.csv").find("slew_angle_rad"),
              ElementsAre(7 - 175, 7 - 179.5, 7 - 185, 7 - 175, 7 - 100, 7 - 15));
  EXPECT_EQ(canonical(skipped, mapping, "run.csv").find("slew_angle_rad")->at(2), 7 - 185);
  EXPECT_THAT(problems_of("[columns]\nslew_voltage_v = { column = \"u\", wraps = 10 }\n"),
              HasSubstr("wraps = 10: is permitted for positions and angles only"));
}

TEST(Mapping, OfRunsOnlyNeedsNoColumns) {
  const auto mapping = parse_mapping("[runs.\"a.csv\"]\nload_mass_kg = 2\n", "their.toml");
  EXPECT_EQ(mapping.runs.at("a.csv").load_mass_kg, 2);
  const auto table = recording::parse_csv("time_s,swing_radial_rad\n0,0.1\n1,0.2\n", "a.csv");
  EXPECT_THAT(*canonical(table, mapping, "a.csv").find("swing_radial_rad"), ElementsAre(0.1, 0.2));
}

TEST(Mapping, WithoutColumnsKeepsCanonicalColumnsOnly) {
  const auto table = recording::parse_csv("tick,time_s,slew_angle_rad\n1,0,2\n", "run.csv");
  EXPECT_THAT(names_of(canonical(table, {}, "run.csv")), ElementsAre("time_s", "slew_angle_rad"));
}

TEST(Mapping, ReportsAllProblemsOfTheFileAtOnceEachWithItsLine) {
  const std::string problems = problems_of(R"([columns]
time_s = { column = "t", sign = -1 }
swing_rad = { column = "theta" }
swing_radial_rad = { factor = 0, colum = "theta" }
slew_angle_rad = { column = "", sign = 0 }
)");
  EXPECT_THAT(problems, HasSubstr("their.toml:2: columns.time_s.sign = -1: time must not run backwards"));
  EXPECT_THAT(problems, HasSubstr("their.toml:3: columns.swing_rad"));
  EXPECT_THAT(problems, HasSubstr("their.toml:4: columns.swing_radial_rad.factor = 0: must be"));
  EXPECT_THAT(problems, HasSubstr("their.toml:4: columns.swing_radial_rad.colum"));
  EXPECT_THAT(problems, HasSubstr("their.toml:5: columns.slew_angle_rad.column"));
  EXPECT_THAT(problems, HasSubstr("their.toml:5: columns.slew_angle_rad.sign = 0: must be 1 or -1"));
}

TEST(Mapping, ReportsEveryMissingColumn) {
  const auto mapping = parse_mapping(
      "[columns]\ntime_s = { column = \"t\" }\nswing_radial_rad = { column = \"theta\" }\n", "their.toml");
  try {
    (void)canonical(recording::parse_csv("a,b\n1,2\n", "run.csv"), mapping, "run.csv");
    FAIL() << "accepted";
  } catch (const DataError& error) {
    EXPECT_THAT(error.problems(),
                ElementsAre(HasSubstr("run.csv: t: missing"), HasSubstr("run.csv: theta: missing")));
  }
}

TEST(Mapping, OfTheMeasuredPendulumGivesAnAngleFromItsEquilibrium) {
  const auto mapping = load_mapping(std::filesystem::path{CRANE_MAPPINGS} / "uw_pendulum.toml");
  const auto rig = configuration::load_rig(std::filesystem::path{CRANE_RIGS} / "uw_pendulum.toml");
  for (const std::string name : {"uw_pendulum_id1.csv", "uw_pendulum_vad1.csv"}) {
    const auto table = recording::read_csv(std::filesystem::path{CRANE_MEASURED} / name);
    const auto loaded = load_run(canonical(table, mapping, name), rig, name);
    ASSERT_EQ(loaded.runs.size(), 1U);
    const auto& swing = loaded.runs[0].measured[kRadialSwing];
    ASSERT_EQ(swing.size(), 917U);
    // A free decay of more than 0.5 rad to both sides, with a small mean.
    double mean = 0;
    for (const double angle : swing) mean += angle / static_cast<double>(swing.size());
    EXPECT_LT(std::abs(mean), 0.05) << name;
    EXPECT_GT(*std::max_element(swing.begin(), swing.end()), 0.5);
    EXPECT_LT(*std::min_element(swing.begin(), swing.end()), -0.5);
  }
}

}  // namespace
}  // namespace crane::diagnosis
