#include "crane/configuration/toml_reader.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::configuration {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> problems_of(TomlTable& root) {
  try {
    root.finish();
  } catch (const ConfigurationError& error) {
    return error.problems();
  }
  return {};
}

TEST(TomlReader, GivesTheValuesOfTheFile) {
  TomlTable root(
      "a_m = 1.5\nn = 3\non = true\nname = 'x'\nlist = [1, 2.5]\n[sub]\nb = 2\n[[row]]\nc = 1\n[[row]]\nc = "
      "2\n",
      "f.toml");
  EXPECT_EQ(root.number("a_m", Range::positive()), 1.5);
  EXPECT_EQ(root.integer("n", 0, 7), 3);
  EXPECT_TRUE(root.boolean("on", false));
  EXPECT_EQ(root.choice("name", {"x", "y"}), "x");
  EXPECT_THAT(root.numbers("list", Range::any()), ElementsAre(1, 2.5));
  EXPECT_EQ(root.table("sub").number("b", Range::any()), 2);  // a number may be written as an integer
  auto rows = root.tables("row");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].integer("c", 0, 9), 1);
  EXPECT_EQ(rows[1].integer("c", 0, 9), 2);
  EXPECT_THAT(problems_of(root), IsEmpty());
}

TEST(TomlReader, GivesDefaultsForMissingKeys) {
  TomlTable root("", "f.toml");
  EXPECT_EQ(root.number("a", Range::any(), 4.0), 4.0);
  EXPECT_EQ(root.integer("b", 0, 9, 5), 5);
  EXPECT_TRUE(root.boolean("c", true));
  EXPECT_EQ(root.text("d", "e"), "e");
  EXPECT_EQ(root.choice("f", {"g", "h"}, "h"), "h");
  EXPECT_FALSE(root.table("sub").present());
  EXPECT_THAT(root.tables("rows"), IsEmpty());
  EXPECT_THAT(problems_of(root), IsEmpty());
}

TEST(TomlReader, RefusesIntegersThatADoubleCannotRepresent) {
  TomlTable root(
      "a = 9223372036854775807\nb = 9007199254740993\nc = [1, -9223372036854775807]\nd = 9007199254740992\n",
      "f.toml");
  EXPECT_TRUE(std::isnan(root.number("a", Range::any())));
  EXPECT_TRUE(std::isnan(root.number("b", Range::any(), 1)));
  EXPECT_THAT(root.numbers("c", Range::any()), ElementsAre(1, testing::IsNan()));
  EXPECT_EQ(root.number("d", Range::any()), 9007199254740992.0);
  const std::string rule = ": must be a decimal number: integers beyond 2^53 are not exact";
  EXPECT_THAT(problems_of(root),
              ElementsAre("f.toml:1: a = 9223372036854775807" + rule, "f.toml:2: b = 9007199254740993" + rule,
                          "f.toml:3: c[1] = -9223372036854775807" + rule));
}

TEST(TomlReader, NamesFileLineNameValueAndRule) {
  TomlTable root("\n[drive]\nvolt_limit_v = 12\n", "f.toml");
  EXPECT_TRUE(std::isnan(root.table("drive").number("volt_limit_v", Range::above(0, 10))));
  EXPECT_THAT(problems_of(root), ElementsAre("f.toml:3: drive.volt_limit_v = 12: must be in (0, 10]"));
}

TEST(TomlReader, RefusesNumbersThatAreNotFinite) {
  TomlTable root("a = nan\nb = inf\nc = -inf\nd = [1.0, nan]\n", "f");
  for (const auto* key : {"a", "b", "c"}) EXPECT_TRUE(std::isnan(root.number(key, Range::any())));
  (void)root.numbers("d", Range::any());
  EXPECT_THAT(problems_of(root),
              ElementsAre("f:1: a = nan: must be finite", "f:2: b = inf: must be finite",
                          "f:3: c = -inf: must be finite", "f:4: d[1] = nan: must be finite"));
}

TEST(TomlReader, RefusesValuesOfAnotherType) {
  TomlTable root("a = '1'\nb = 1.5\nc = 1\nd = 2\ne = 3\nf = 4\n", "f");
  (void)root.number("a", Range::any());
  (void)root.integer("b", 0, 7);
  (void)root.boolean("c", false);
  (void)root.text("d");
  (void)root.table("e");
  (void)root.tables("f");
  EXPECT_THAT(problems_of(root),
              ElementsAre("f:1: a = \"1\": must be a number", "f:2: b = 1.5: must be an integer in [0, 7]",
                          "f:3: c = 1: must be true or false", "f:4: d = 2: must be a text in quotes",
                          "f:5: e = 3: must be a table", "f:6: f = 4: must be an array of tables"));
}

TEST(TomlReader, SuggestsTheNearestKeyForAnUnknownOne) {
  TomlTable root("[plant]\ntroley_mass_kg = 2\n\nsomething_else_entirely = 1\n", "f");
  auto plant = root.table("plant");
  (void)plant.number("trolley_mass_kg", Range::any(), 0);
  (void)plant.number("load_mass_kg", Range::any(), 0);
  EXPECT_THAT(problems_of(root),
              ElementsAre("f:2: plant.troley_mass_kg = 2: unknown key; did you mean trolley_mass_kg?",
                          "f:4: plant.something_else_entirely = 1: unknown key"));
}

TEST(TomlReader, NamesTheUnitThatAKeyMustHave) {
  TomlTable root("slew_angle_deg = 90\n", "f");
  (void)root.number("slew_angle_rad", Range::any());  // required; only the wrong unit is reported
  EXPECT_THAT(problems_of(root), ElementsAre("f:1: slew_angle_deg = 90: unit must be rad: slew_angle_rad"));
}

TEST(TomlReader, AcceptsBothUnitsOfAKeyWithTwoUnits) {
  TomlTable root("slew_angle_deg = 90\n", "f");
  EXPECT_FALSE(root.has("slew_angle_rad"));
  EXPECT_EQ(root.number("slew_angle_deg", Range::any(), 0), 90);
  EXPECT_THAT(problems_of(root), IsEmpty());
}

TEST(TomlReader, ReportsMissingKeysAtTheirTable) {
  TomlTable root("name = 'x'\n\n[drive]\n", "f");
  (void)root.text("name");
  (void)root.table("drive").number("limit_m", Range::any());
  // the missing table is reported, not each of its keys
  (void)root.required_table("plant").number("mass_kg", Range::any());
  EXPECT_THAT(problems_of(root), ElementsAre("f:1: plant: missing", "f:3: drive.limit_m: missing"));
}

TEST(TomlReader, ReportsSyntaxErrorsWithTheirLine) {
  try {
    TomlTable root("a = 1\nb = = 2\n", "f.toml");
    FAIL() << "accepted";
  } catch (const ConfigurationError& error) {
    ASSERT_EQ(error.problems().size(), 1U);
    EXPECT_THAT(error.what(), testing::StartsWith("f.toml:2: syntax: "));
  }
}

TEST(TomlReader, SortsAllProblemsByLine) {
  TomlTable root("x = 1\na = -1\n[t]\nb = -1\n", "f");
  auto table = root.table("t");
  (void)table.number("b", Range::positive());
  table.problem("b", "must please");
  (void)root.number("a", Range::positive());
  EXPECT_THAT(problems_of(root),
              ElementsAre("f:1: x = 1: unknown key; did you mean a?", "f:2: a = -1: must be finite and > 0",
                          "f:4: t.b = -1: must be finite and > 0", "f:4: t.b = -1: must please"));
}

TEST(TomlReader, ShowsAllProblemsOneALine) {
  TomlTable root("a = -1\nb = -1\n", "f");
  (void)root.number("a", Range::positive());
  (void)root.number("b", Range::not_negative());
  try {
    root.finish();
    FAIL() << "accepted";
  } catch (const ConfigurationError& error) {
    EXPECT_STREQ(error.what(), "f:1: a = -1: must be finite and > 0\nf:2: b = -1: must be finite and >= 0");
  }
}

TEST(TomlReader, TakesMissingKeysFromTheBaseAndNamesItsLines) {
  TomlTable root("[t]\na = 1\nrows = []\n", "own");
  root.inherit(TomlTable("b = -2\n[t]\na = 3\nc = 4\n[[t.rows]]\nd = 1\n", "base"));
  EXPECT_EQ(root.table("t").number("a", Range::any()), 1);
  EXPECT_EQ(root.table("t").number("c", Range::any()), 4);
  EXPECT_THAT(root.table("t").tables("rows"), IsEmpty());
  (void)root.number("b", Range::positive());
  EXPECT_THAT(problems_of(root), ElementsAre("base:1: b = -2: must be finite and > 0"));
}

std::string refusal_of(const std::string& text) {
  try {
    TomlTable root(text, "f");
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "";
}

std::string key_of(int parts) {
  std::string key = "a";
  for (int i = 1; i < parts; ++i) key += i % 2 == 0 ? " . \"x=\"" : ".b";
  return key;
}

/// toml++ puts each part into a separate table and frees the tables recursively. 100,000 parts would crash
/// the program.
TEST(TomlReader, RefusesAKeyWithMoreThan32Parts) {
  const std::string many = key_of(33), rule = "a key must have at most 32 parts";
  EXPECT_EQ(refusal_of("\n" + key_of(100'000) + " = 1\n"), "f:2: " + rule);
  for (const auto& text : {many + " = 1", "[" + many + "]", "[[" + many + "]]", "x = {" + many + " = 1}",
                           "x = [\"\"\"a\"\"\"\"\", {" + many + " = 1}]", "x = ['\\', {" + many + " = 1}]",
                           "x = \"\\\"\" # \"\n" + many + " = 1"})
    EXPECT_THAT(refusal_of(text), HasSubstr(rule)) << text;
}

TEST(TomlReader, CountsTheDotsOfKeysOnly) {
  const std::string dots(100, '.');
  for (const auto& text : {key_of(32) + " = 1", "# " + dots, "x = \"" + dots + "\"", "x = '" + dots + "'",
                           "x = \"\"\"\n\"" + dots + "\"\n\"\"\"", "\"" + dots + "\" = 1",
                           "x = [0.1, 0.2" + std::string(1000, ' ') + ", 0.3]"})
    EXPECT_EQ(refusal_of(text), "") << text;
}

TEST(TomlReader, RefusesATextThatIsLongerThanOneMegabyte) {
  EXPECT_EQ(refusal_of(std::string(1U << 20U, '\n')), "");
  EXPECT_THAT(refusal_of(std::string((1U << 20U) + 1, '\n')), HasSubstr("at most 1 MB"));
}

TEST(TomlReader, ReadsAtMostOneMegabyteOfADeviceWithoutEnd) {
  EXPECT_THROW((void)with_base(file_text("/dev/zero"), "/dev/zero"), ConfigurationError);
}

TEST(TomlReader, ShowsControlCharactersOfAKeyAsPrintableText) {
  TomlTable root("\"\\u001b[2J\\u202e\" = 1\n", "f");
  for (const auto& problem : problems_of(root))
    EXPECT_EQ(problem.find_first_of("\x1b\xe2"), std::string::npos) << problem;
}

TEST(Range, TakesItsEndsAsDeclared) {
  EXPECT_TRUE(Range::closed(0, 1).contains(0));
  EXPECT_TRUE(Range::above(0, 1).contains(1));
  EXPECT_FALSE(Range::above(0, 1).contains(0));
  EXPECT_FALSE(Range::open(0, 1).contains(1));
  EXPECT_TRUE(Range::any().contains(-1e300));
  EXPECT_FALSE(Range::any().contains(Range::kInfinity));
  EXPECT_FALSE(Range::any().contains(std::nan("")));
}

}  // namespace
}  // namespace crane::configuration
