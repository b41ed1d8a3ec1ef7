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

}  // namespace
}  // namespace crane::cli
