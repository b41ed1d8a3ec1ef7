#include "crane/recording/csv.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <sstream>

#include "temporary_directory.hpp"

namespace crane::recording {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string written(const Table& table) {
  std::ostringstream out;
  write_csv(out, table);
  return out.str();
}

TEST(Csv, WritesOneLinePerRowWithShortestNumbers) {
  const Table table{{{"time_s", {0, 0.01}}, {"trolley_position_m", {0.25, 1.0 / 3}}}};
  EXPECT_EQ(written(table), "time_s,trolley_position_m\n0,0.25\n0.01,0.3333333333333333\n");
}

TEST(Csv, ReadsBackEveryDoubleBitForBit) {
  constexpr std::uint64_t kSeed = 99;
  std::mt19937_64 random{kSeed};
  Table table{
      {{"time_s",
        {0, -0.0, 5e-324, std::numeric_limits<double>::max(), std::numeric_limits<double>::infinity()}}}};
  while (table.rows() < 20'000) {
    const double value = std::bit_cast<double>(random());
    if (!std::isnan(value)) table.columns[0].values.push_back(value);
  }
  const Table again = parse_csv(written(table), "a.csv");
  ASSERT_EQ(again.rows(), table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i)
    ASSERT_EQ(std::bit_cast<std::uint64_t>(again.columns[0].values[i]),
              std::bit_cast<std::uint64_t>(table.columns[0].values[i]))
        << "seed " << kSeed << " row " << i;
}

TEST(Csv, WritesAndReadsMissingValuesAsNan) {
  EXPECT_EQ(written({{{"time_s", {std::nan(""), -std::nan("")}}}}), "time_s\nnan\nnan\n");
  const Table table = parse_csv("time_s,slew_angle_rad\n0,\n1,nan\n", "a.csv");
  EXPECT_TRUE(std::isnan((*table.find("slew_angle_rad"))[0]));
  EXPECT_TRUE(std::isnan((*table.find("slew_angle_rad"))[1]));
}

TEST(Csv, ReadsFilesOfLaboratories) {
  const Table table = parse_csv(
      "\xEF\xBB\xBF# rig 3\r\n\r\n time_s , swing_radial_rad\r\n0, +1.5e-3\r\n# pause\r\n.5,-2", "a.csv");
  EXPECT_THAT(*table.find("time_s"), ElementsAre(0, 0.5));
  EXPECT_THAT(*table.find("swing_radial_rad"), ElementsAre(0.0015, -2));
}

TEST(Csv, ReadsSemicolonsAndTabsWithDecimalCommas) {
  for (const std::string& text : {std::string{"t;x;y\r\n0,5;-1,25e-3;\r\n1.5;;2\r\n"},
                                  std::string{"t\tx\ty\n0,5\t-1,25e-3\t\n1.5\t\t2\n"}}) {
    const Table table = parse_csv(text, "a.csv");
    EXPECT_THAT(*table.find("t"), ElementsAre(0.5, 1.5));
    EXPECT_DOUBLE_EQ(table.find("x")->at(0), -0.00125);
    EXPECT_TRUE(std::isnan(table.find("x")->at(1)));
    EXPECT_TRUE(std::isnan(table.find("y")->at(0)));
    EXPECT_EQ(table.find("y")->at(1), 2);
  }
}

TEST(Csv, TakesTheMostFrequentSeparatorOfTheHeader) {
  EXPECT_THAT(*parse_csv("time_s,\tx\n0,\t1\n", "a.csv").find("x"), ElementsAre(1));
  EXPECT_THAT(*parse_csv("time_s,x,y [m; low end]\n0,1,2\n", "a.csv").find("x"), ElementsAre(1));
  EXPECT_THAT(*parse_csv("t;x, filtered;y\n0;1,5;2\n", "a.csv").find("x, filtered"), ElementsAre(1.5));
}

TEST(Csv, ReadsDatesAsSecondsSince1970) {
  const std::map<std::string, double> dates{{"1970-01-01T00:00:00", 0},
                                            {"1970-01-02 00:00:01.25", 86401.25},
                                            {"2000-03-01T00:00:00Z", 951868800},
                                            {"2024-03-14T10:22:31,551", 1710411751.551},
                                            {"2024-03-14T11:22:31.551+01:00", 1710411751.551},
                                            {"2024-03-14T05:52:31.551-0430", 1710411751.551}};
  for (const auto& [date, time_s] : dates)
    EXPECT_NEAR(parse_csv("t;x\n" + date + ";1\n", "a.csv").find("t")->at(0), time_s, 1e-6) << date;
  for (const std::string date :
       {"2024-02-30T00:00:00", "2024-13-01T00:00:00", "2024-03-14T24:00:00", "2024-03-14", "2024-03-14T10:22",
        "2024-03-14T10:22:31.", "2024-3-14T10:22:31", "2024-03-14T10:22:31+1", "2024-03-14T10:22:31Zx",
        "2024--3-14T10:22:31"})
    EXPECT_THROW((void)parse_csv("t;x\n" + date + ";1\n", "a.csv"), CsvError) << date;
}

TEST(Csv, KeepsOnlyTheWantedColumnsInTheWantedOrder) {
  const std::string text = "note,time_s,extra,cable_length_m\nhello,0,1,2\nworld,1,3,4\n";
  const Table table = parse_csv(text, "a.csv", {"cable_length_m", "slew_angle_rad", "time_s"});
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_EQ(table.columns[0].name, "cable_length_m");
  EXPECT_THAT(*table.find("time_s"), ElementsAre(0, 1));
  EXPECT_EQ(table.find("extra"), nullptr);
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Csv, NamesFileLineAndReasonOfBadInput) {
  const auto parse = [](const std::string& text) {
    return error_of([&] { (void)parse_csv(text, "a.csv"); });
  };
  EXPECT_EQ(parse(""), "a.csv:1: has no header line");
  EXPECT_EQ(parse("# only\n\n"), "a.csv:2: has no header line");
  EXPECT_EQ(parse("time_s,time_s\n"), "a.csv:1: column time_s occurs twice");
  EXPECT_EQ(parse("time_s,,x\n"), "a.csv:1: column 2 has no name");
  EXPECT_EQ(parse("time_s,x\n0,1\n0\n"), "a.csv:3: 1 cells, the header has 2");
  EXPECT_EQ(parse("time_s\n0.1.2\n"), "a.csv:2: time_s = \"0.1.2\": is not a number");
  EXPECT_EQ(parse("time_s;x\n0;1,234.5\n"), "a.csv:2: x = \"1,234.5\": is not a number");
  EXPECT_EQ(parse("time_s\n1e999\n"), "a.csv:2: time_s = \"1e999\": is not a number");
  EXPECT_EQ(error_of([] { (void)read_csv("/nowhere/a.csv"); }),
            "/nowhere/a.csv: cannot read: No such file or directory");
}

TEST(Csv, RefusesTablesThatCannotBeReadBack) {
  EXPECT_THAT(error_of([] {
                (void)written({{{"a,b", {1}}}});
              }),
              HasSubstr("must not be empty or contain a comma"));
  EXPECT_THAT(error_of([] {
                (void)written({{{"a", {1}}, {"a", {1}}}});
              }),
              HasSubstr("column a occurs twice"));
  EXPECT_THAT(error_of([] {
                (void)written({{{"a", {1}}, {"b", {1, 2}}}});
              }),
              HasSubstr("column b has 2 rows"));
}

TEST(Csv, NamesFileAndReasonWhenItCannotWrite) {
  const Table table{{{"time_s", {0}}}};
  EXPECT_EQ(error_of([&] { write_csv(std::filesystem::path{"/nowhere/a.csv"}, table); }),
            "/nowhere/a.csv: cannot write: No such file or directory");
  EXPECT_EQ(error_of([&] { write_csv(std::filesystem::path{"/dev/full"}, table); }),
            "/dev/full: cannot write: No space left on device");
}

TEST(Csv, ShowsTheBeginOfALongCellAndNoControlCharacter) {
  try {
    (void)parse_csv("a\n\x1b[2J" + std::string(1'000'000, '1') + "\n", "f", {});
    FAIL() << "accepted";
  } catch (const CsvError& error) {
    const std::string what = error.what();
    EXPECT_LT(what.size(), 200U);
    EXPECT_EQ(what.find('\x1b'), std::string::npos);
  }
}

TEST(Csv, ReadsTheFileItWrote) {
  const TemporaryDirectory directory;
  write_csv(directory / "a.csv", Table{{{"time_s", {0, 0.01}}}});
  EXPECT_THAT(*read_csv(directory / "a.csv").find("time_s"), ElementsAre(0, 0.01));
}

}  // namespace
}  // namespace crane::recording
