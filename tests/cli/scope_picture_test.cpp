/// A capture as curves and as a table.
#include "cli/scope_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "crane/fields/angle.hpp"
#include "crane/topics.hpp"

namespace crane::cli {
namespace {

using observation::Capture, observation::FieldSelection, observation::FieldTable;
using testing::HasSubstr;

class ScopePicture : public testing::Test {
 protected:
  ScopePicture() {
    selection_.add("state.swing_radial_rad");
    selection_.add("supervisor.state");
    for (std::uint64_t tick = 100; tick <= 130; ++tick) {
      const double swing_rad = (static_cast<double>(tick) - 110) * fields::kRadPerDeg;
      capture_.rows.push_back(
          {tick,
           static_cast<std::int64_t>(tick) * 10'000'000,
           {swing_rad, static_cast<double>(tick < 110 ? crane_STATE_RUN : crane_STATE_STOP_C1)}});
    }
    capture_.trigger = 10;
  }
  [[nodiscard]] std::string picture(const TerminalSize& size) const {
    return picture_of(capture_, table_, selection_.columns(), "the trigger", size);
  }

  FieldTable table_;
  FieldSelection selection_{table_};
  Capture capture_;
};

TEST_F(ScopePicture, NamesTickUnitsExtremesAndTheValueAtTheTrigger) {
  const auto text = picture({.columns = 80, .rows = 24});
  EXPECT_THAT(text, testing::StartsWith("trigger at tick 110: the trigger  (31 ticks)\n"));
  EXPECT_THAT(text, HasSubstr("state.swing_radial_rad [deg]  min -10  max 20  at trigger 0\n"));
  EXPECT_THAT(text,
              HasSubstr("supervisor.state  min STATE_RUN  max STATE_STOP_C1  at trigger STATE_STOP_C1\n"));
  EXPECT_THAT(text, HasSubstr("-0.10 s"));
  EXPECT_THAT(text, HasSubstr("0.20 s"));
}

TEST_F(ScopePicture, FitsTheTerminal) {
  for (const TerminalSize size : {TerminalSize{80, 24}, TerminalSize{140, 50}, TerminalSize{40, 14}}) {
    const auto text = picture(size);
    EXPECT_LE(std::ranges::count(text, '\n'), size.rows);
    std::istringstream lines{text.substr(text.find("]  min"))};
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line))
      if (line.find("┤") != std::string::npos || line.find("│") != std::string::npos) {
        EXPECT_LE(width_of(line), static_cast<std::size_t>(size.columns));
      }
  }
}

TEST_F(ScopePicture, OfTinyTerminalsAndOfNoRowsIsDrawnWithoutError) {
  for (const TerminalSize size : {TerminalSize{0, 0}, TerminalSize{1, 1}, TerminalSize{12, 3}})
    EXPECT_FALSE(picture(size).empty());
  capture_.rows.resize(1);
  capture_.trigger = 0;
  EXPECT_FALSE(picture({}).empty());
  capture_ = {};
  EXPECT_THAT(picture({}), testing::StartsWith("no trigger (automatic)"));
}

TEST_F(ScopePicture, TableHasTheTimeFromTheTriggerAndSiUnits) {
  const auto table = table_of(capture_, table_, selection_.columns());
  ASSERT_EQ(table.columns.size(), 4U);
  EXPECT_NEAR(table.find("time_s")->front(), -0.1, 1e-12);
  EXPECT_EQ(table.find("time_s")->at(10), 0);
  EXPECT_EQ(table.find("tick")->back(), 130);
  EXPECT_NEAR(table.find("state.swing_radial_rad")->back(), 20 * fields::kRadPerDeg, 1e-12);
  EXPECT_EQ(table.find("supervisor.state")->back(), crane_STATE_STOP_C1);
}

}  // namespace
}  // namespace crane::cli
