#include "cli/units.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace crane::cli {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Units, TakeAPlainNumberAsMetresOrRadians) {
  EXPECT_EQ(parse_quantity("1.05", Dimension::length), 1.05);
  EXPECT_EQ(parse_quantity("-1.57", Dimension::angle), -1.57);
  EXPECT_EQ(parse_quantity("+2e-1", Dimension::length), 0.2);
}

TEST(Units, ConvertTheUnitsOfLengthAndAngle) {
  EXPECT_EQ(parse_quantity("1.05m", Dimension::length), 1.05);
  EXPECT_DOUBLE_EQ(parse_quantity("105cm", Dimension::length), 1.05);
  EXPECT_DOUBLE_EQ(parse_quantity("1050 mm", Dimension::length), 1.05);
  EXPECT_DOUBLE_EQ(parse_quantity("90deg", Dimension::angle), std::numbers::pi / 2);
  EXPECT_EQ(parse_quantity(" 0.5 rad ", Dimension::angle), 0.5);
}

TEST(Units, RefuseUnitsOfAnotherDimensionAndListTheValidUnits) {
  EXPECT_THAT([] { (void)parse_quantity("90deg", Dimension::length); },
              ThrowsMessage<UnitError>(HasSubstr("m (default), cm, mm")));
  EXPECT_THAT([] { (void)parse_quantity("1m", Dimension::angle); },
              ThrowsMessage<UnitError>(HasSubstr("rad (default), deg")));
  EXPECT_THAT([] { (void)parse_quantity("3ft", Dimension::length); },
              ThrowsMessage<UnitError>(HasSubstr("'ft'")));
}

TEST(Units, RefuseValuesThatAreNotFiniteNumbers) {
  for (const char* text : {"", " ", "m", "deg", "nan", "inf", "1e999", "--1", "+-1", "0x10", "1,05"})
    EXPECT_THROW((void)parse_quantity(text, Dimension::length), UnitError) << text;
}

TEST(Units, ConvertLongTimesToSeconds) {
  EXPECT_EQ(parse_duration("90"), 90);
  EXPECT_EQ(parse_duration("1500ms"), 1.5);
  EXPECT_EQ(parse_duration("10min"), 600);
  EXPECT_EQ(parse_duration("1.5 h"), 5400);
  EXPECT_EQ(parse_duration("2d"), 172'800);
  for (const char* text : {"0", "0min", "-1h", "nan", "h", "10 minutes", ""})
    EXPECT_THROW((void)parse_duration(text), UnitError) << text;
}

TEST(Units, ConvertSizesToBytes) {
  EXPECT_EQ(parse_bytes("4096"), 4096U);
  EXPECT_EQ(parse_bytes("500MB"), 500'000'000U);
  EXPECT_EQ(parse_bytes("1.5 kB"), 1500U);
  EXPECT_EQ(parse_bytes("2GiB"), 2147483648U);
  for (const char* text : {"0", "0MB", "-1MB", "nan", "inf", "MB", "1 megabyte", "1mb", "1e30", ""})
    EXPECT_THROW((void)parse_bytes(text), UnitError) << text;
}

}  // namespace
}  // namespace crane::cli
