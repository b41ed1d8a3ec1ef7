// The supervisor detects sample times of crane/state that contradict their ticks. A tick is 10 ms.
#include "process/bridge_clock.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>

namespace crane::supervisor {
namespace {

using enum BridgeClock::Verdict;

constexpr std::int64_t kTick_ns = 10'000'000, kFirst_ns = 123'456'789'012;
constexpr std::int64_t kLatest_ns = std::numeric_limits<std::int64_t>::max();

msg::Header stamped(std::uint64_t tick, std::int64_t late_ns = 0) {
  msg::Header made{};
  made.tick = tick;
  made.sample_time_ns = kFirst_ns + static_cast<std::int64_t>(tick) * kTick_ns + late_ns;
  return made;
}
msg::Header with_time(std::uint64_t tick, std::int64_t time_ns) {
  msg::Header made = stamped(tick);
  made.sample_time_ns = time_ns;
  return made;
}

class TimesOfTheBridge : public testing::Test {
 protected:
  TimesOfTheBridge() {
    for (std::uint64_t tick = 1; tick <= 10; ++tick) EXPECT_EQ(clock_.take(stamped(tick)), fits);
  }
  BridgeClock clock_{kTick_ns};
};

TEST_F(TimesOfTheBridge, FitWithAnyLatenessAndAnyNumberOfSkippedTicks) {
  constexpr std::uint64_t kSeed = 7;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random{kSeed};
  for (std::uint64_t tick = 11, k = 0; k < 10'000; ++k, tick += 1 + random() % 3 * (random() % 500)) {
    const auto late_ns = static_cast<std::int64_t>(random() % kTick_ns);
    ASSERT_EQ(clock_.take(stamped(tick, late_ns)), fits) << "tick " << tick;
  }
}

TEST_F(TimesOfTheBridge, ThatStandStillOrJumpContradictTheTicks) {
  for (const std::int64_t time_ns :
       {stamped(10).sample_time_ns, std::int64_t{0}, std::int64_t{-1}, kLatest_ns,
        std::numeric_limits<std::int64_t>::min(), stamped(11, 2 * kTick_ns).sample_time_ns,
        stamped(11, -2 * kTick_ns).sample_time_ns})
    EXPECT_EQ(clock_.take(with_time(11, time_ns)), contradicts) << time_ns;
  EXPECT_EQ(clock_.take(stamped(12)), fits);
}

/// Each step between samples deviates from a period by less than a period; the sum of the steps deviates by
/// more.
TEST_F(TimesOfTheBridge, ThatRunTooFastOrTooSlowlyContradictTheTicks) {
  for (const std::int64_t step_ns : {kTick_ns / 2, kTick_ns * 19 / 10, kTick_ns + kTick_ns / 100}) {
    BridgeClock clock{kTick_ns};
    std::uint64_t tick = 0;
    std::int64_t time_ns = kFirst_ns;
    while (tick < 150 && clock.take(with_time(tick, time_ns)) == fits) ++tick, time_ns += step_ns;
    EXPECT_LT(tick, 102U) << step_ns;
  }
}

TEST_F(TimesOfTheBridge, ThatContradictTheTicksDoNotChangeTheClock) {
  EXPECT_EQ(clock_.local_ns(stamped(10).sample_time_ns, 500), 500);
  EXPECT_EQ(clock_.take(with_time(11, kLatest_ns)), contradicts);
  EXPECT_FALSE(clock_.fits(with_time(12, kLatest_ns)));
  EXPECT_EQ(clock_.local_ns(stamped(12).sample_time_ns, 500 + 2 * kTick_ns), 500 + 2 * kTick_ns);
}

TEST(FirstTimeOfABridge, IsReplacedWhenAHundredLaterTimesAgreeWithEachOther) {
  BridgeClock clock{kTick_ns};
  EXPECT_EQ(clock.take(with_time(1, kLatest_ns)), fits);
  std::uint64_t tick = 2;
  for (int k = 1; k < BridgeClock::kAgreeing; ++k) EXPECT_EQ(clock.take(stamped(tick++)), contradicts) << k;
  EXPECT_EQ(clock.take(stamped(tick++)), begins_anew);
  EXPECT_EQ(clock.take(stamped(tick++)), fits);
}

TEST(FirstTimeOfABridge, IsKeptWhileLaterTimesDisagreeWithEachOther) {
  BridgeClock clock{kTick_ns};
  EXPECT_EQ(clock.take(with_time(1, kLatest_ns)), fits);
  for (std::uint64_t tick = 2; tick < 1000; ++tick)
    EXPECT_EQ(clock.take(stamped(tick, tick % 2 == 0 ? 0 : 3 * kTick_ns)), contradicts) << tick;
}

}  // namespace
}  // namespace crane::supervisor
