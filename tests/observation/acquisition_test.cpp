/// Trigger and window of the oscilloscope as timelines at 100 Hz.
#include "observation/acquisition.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "samples.hpp"

namespace crane::observation {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct Timeline {
  explicit Timeline(const Acquisition::Window& window) : acquisition{window} {}
  /// `ticks` rows with the same condition.
  void run(int ticks, double condition) {
    for (int i = 0; i < ticks; ++i) {
      ++tick;
      if (auto capture =
              acquisition.add({tick, static_cast<std::int64_t>(tick) * kLoopPeriod_ns, {}}, condition))
        captures.push_back(std::move(*capture));
    }
  }
  Acquisition acquisition;
  std::uint64_t tick = 0;
  std::vector<Capture> captures;
};

constexpr Acquisition::Window kWindow{.before_ns = 100'000'000, .after_ns = 200'000'000};

TEST(Acquisition, CapturesFromBeforeToAfterTheTickInWhichTheConditionBecomesTrue) {
  Timeline at{kWindow};
  at.run(50, 0);
  at.run(20, 1);  // tick 51 to 70
  EXPECT_TRUE(at.captures.empty());
  at.run(1, 0);
  ASSERT_EQ(at.captures.size(), 1U);
  const auto& capture = at.captures[0];
  ASSERT_TRUE(capture.trigger);
  EXPECT_EQ(capture.rows[*capture.trigger].tick, 51U);
  EXPECT_EQ(capture.rows.front().tick, 41U);
  EXPECT_EQ(capture.rows.back().tick, 71U);
  EXPECT_TRUE(capture.complete);
}

TEST(Acquisition, ConditionThatIsTrueFromTheStartTriggersAfterItHasBeenFalse) {
  Timeline at{kWindow};
  at.run(100, 1);
  EXPECT_FALSE(at.acquisition.triggered());
  at.run(1, 0);
  at.run(1, 1);
  EXPECT_TRUE(at.acquisition.triggered());
}

TEST(Acquisition, UnknownConditionNeitherTriggersNorHidesTheEdge) {
  Timeline at{kWindow};
  at.run(20, kUnknown);
  at.run(20, 1);
  EXPECT_FALSE(at.acquisition.triggered());
  at.run(1, 0);
  at.run(3, kUnknown);
  EXPECT_FALSE(at.acquisition.triggered());
  at.run(1, 1);
  EXPECT_TRUE(at.acquisition.triggered());
}

TEST(Acquisition, TriggerShortlyAfterTheStartHasFewerRowsBefore) {
  Timeline at{kWindow};
  at.run(3, 0);
  at.run(21, 1);
  ASSERT_EQ(at.captures.size(), 1U);
  EXPECT_EQ(at.captures[0].trigger, 3U);
  EXPECT_EQ(at.captures[0].rows.size(), 24U);
}

TEST(Acquisition, TriggersWithinACaptureAreIgnoredAndTheNextCaptureHasItsOwnPast) {
  Timeline at{kWindow};
  at.run(20, 0);
  for (int i = 0; i < 10; ++i) {  // tick 21 triggers; 23, 25 ... do not
    at.run(1, 1);
    at.run(1, 0);
  }
  at.run(1, 0);  // tick 41 ends the first capture
  ASSERT_EQ(at.captures.size(), 1U);
  at.run(2, 0);
  at.run(30, 1);  // tick 44
  ASSERT_EQ(at.captures.size(), 2U);
  EXPECT_EQ(at.captures[0].rows[*at.captures[0].trigger].tick, 21U);
  EXPECT_EQ(at.captures[1].rows[*at.captures[1].trigger].tick, 44U);
  EXPECT_EQ(at.captures[1].rows.front().tick, 34U) << "the past of a capture may overlap the capture before";
}

TEST(Acquisition, AutoModeCapturesWithoutATriggerAfterThePreAndPostTimes) {
  auto window = kWindow;
  window.automatic = true;
  Timeline at{window};
  at.run(31, 0);
  ASSERT_EQ(at.captures.size(), 1U);
  EXPECT_FALSE(at.captures[0].trigger);
  EXPECT_EQ(at.captures[0].rows.size(), 31U);
  at.run(29, 0);
  EXPECT_EQ(at.captures.size(), 1U);
  at.run(30, 1);  // the trigger in tick 61 replaces the automatic capture
  ASSERT_EQ(at.captures.size(), 2U);
}

TEST(Acquisition, EndOfTheDataGivesAnIncompleteCaptureOnlyAfterATrigger) {
  Timeline at{kWindow};
  at.run(20, 0);
  EXPECT_FALSE(at.acquisition.finish());
  at.run(5, 1);
  const auto capture = at.acquisition.finish();
  ASSERT_TRUE(capture);
  EXPECT_FALSE(capture->complete);
  EXPECT_EQ(capture->rows[*capture->trigger].tick, 21U);
  EXPECT_FALSE(at.acquisition.finish()) << "once";
}

TEST(Acquisition, RingHoldsTheTimeBeforeTheTriggerAndNeverMoreThanItsLimit) {
  Timeline at{kWindow};
  at.run(100'000, 0);
  at.run(21, 1);
  ASSERT_EQ(at.captures.size(), 1U);
  EXPECT_EQ(at.captures[0].rows.size(), 31U);

  Timeline longest{{.before_ns = std::int64_t{1} << 60, .after_ns = 0}};
  longest.run(static_cast<int>(Acquisition::kMostRows) + 500, 0);
  longest.run(1, 1);
  ASSERT_EQ(longest.captures.size(), 1U);
  EXPECT_EQ(longest.captures[0].rows.size(), Acquisition::kMostRows);
}

TEST(Acquisition, RestartedClockMasterBeginsAnew) {
  Timeline at{kWindow};
  at.run(500, 0);
  at.tick = 0;
  at.run(5, 0);
  at.run(21, 1);
  ASSERT_EQ(at.captures.size(), 1U);
  EXPECT_EQ(at.captures[0].rows.front().tick, 1U);
}

}  // namespace
}  // namespace crane::observation
