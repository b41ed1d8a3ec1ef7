// The recorder counts each missing sample once, whenever DDS reports it.
#include "recorder/missing_samples.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>

namespace crane::recorder {
namespace {

using recording::LossCause;
constexpr std::int64_t kSecond_ns = 1'000'000'000, kPeriod_ns = 10'000'000;

/// Sums of what take() has returned until now.
class Counted {
 public:
  explicit Counted(bool every_tick = true) : missing{every_tick} {}
  void until(std::int64_t end_ns) {
    for (; now_ns < end_ns; now_ns += kPeriod_ns) add(missing.take(now_ns, false));
  }
  void close() { add(missing.take(now_ns, true)); }
  [[nodiscard]] std::uint64_t sum() const {
    std::uint64_t result = 0;
    for (const auto& [cause, samples] : by_cause) result += samples;
    return result;
  }
  MissingSamples missing;
  std::int64_t now_ns = 0;
  std::map<LossCause, std::uint64_t> by_cause;

 private:
  void add(const std::vector<MissingSamples::Found>& found) {
    for (const auto& one : found) by_cause[one.cause] += one.samples;
  }
};

using Causes = std::map<LossCause, std::uint64_t>;

TEST(MissingSamples, AReportSoonAfterOrBeforeItsGapIsOneLoss) {
  Counted after, before;
  after.missing.gap(7, 0);
  after.until(kSecond_ns / 2);
  after.missing.report(LossCause::dds_lost, 7, after.now_ns);
  after.until(5 * kSecond_ns);
  after.close();
  EXPECT_EQ(after.by_cause, (Causes{{LossCause::dds_lost, 7}}));
  before.missing.report(LossCause::dds_lost, 7, 0);
  before.until(kSecond_ns / 2);
  before.missing.gap(7, before.now_ns);
  before.until(5 * kSecond_ns);
  before.close();
  EXPECT_EQ(before.by_cause, (Causes{{LossCause::dds_lost, 7}}));
}

/// Nothing is received for 3 s. DDS reports the loss at once; the gap is visible with the next sample.
TEST(MissingSamples, AGapThatIsVisibleLongAfterItsReportIsOneLoss) {
  Counted counted;
  counted.missing.report(LossCause::dds_lost, 300, 0);
  counted.until(3 * kSecond_ns);
  counted.missing.gap(300, counted.now_ns);
  counted.until(6 * kSecond_ns);
  counted.close();
  EXPECT_EQ(counted.by_cause, (Causes{{LossCause::dds_lost, 300}}));
}

/// DDS reports the loss with a heartbeat, 2.5 s after the next sample.
TEST(MissingSamples, AReportLongAfterItsGapIsOneLoss) {
  Counted counted;
  counted.missing.gap(40, 0);
  counted.until(5 * kSecond_ns / 2);
  EXPECT_EQ(counted.by_cause, (Causes{{LossCause::tick_gap, 40}}));
  counted.missing.report(LossCause::dds_lost, 40, counted.now_ns);
  counted.until(5 * kSecond_ns);
  counted.close();
  EXPECT_EQ(counted.sum(), 40U);
}

/// One report of several gaps.
TEST(MissingSamples, AReportExplainsSeveralGaps) {
  Counted counted;
  counted.missing.report(LossCause::dds_lost, 10, 0);
  counted.until(2 * kSecond_ns);
  counted.missing.gap(4, counted.now_ns);
  counted.until(2 * kSecond_ns + 5 * kPeriod_ns);
  counted.missing.gap(6, counted.now_ns);
  counted.until(5 * kSecond_ns);
  counted.close();
  EXPECT_EQ(counted.by_cause, (Causes{{LossCause::dds_lost, 10}}));
}

TEST(MissingSamples, AnEarlierGapOfALateLoopDoesNotHideALaterLoss) {
  Counted counted;
  counted.missing.gap(3, 0);  // the loop skipped three ticks; DDS reports nothing
  counted.until(10 * kSecond_ns);
  counted.missing.report(LossCause::dds_lost, 3, counted.now_ns);
  counted.missing.gap(3, counted.now_ns + kPeriod_ns);
  counted.until(15 * kSecond_ns);
  counted.close();
  EXPECT_EQ(counted.by_cause, (Causes{{LossCause::tick_gap, 3}, {LossCause::dds_lost, 3}}));
}

TEST(MissingSamples, RejectedSamplesAreTheirGap) {
  Counted counted;
  counted.missing.report(LossCause::wrong_crc, 2, 0);
  counted.missing.gap(2, kPeriod_ns);
  counted.until(3 * kSecond_ns);
  counted.close();
  EXPECT_EQ(counted.by_cause, (Causes{{LossCause::wrong_crc, 2}}));
}

TEST(MissingSamples, AReportOfATopicWithoutTicksIsNotedAtOnce) {
  Counted counted{false};
  counted.missing.report(LossCause::dds_lost, 5, 0);
  counted.until(kPeriod_ns);
  EXPECT_EQ(counted.by_cause, (Causes{{LossCause::dds_lost, 5}}));
}

TEST(MissingSamples, AReportAboutTheLastSamplesOfAWriterHidesNoGapOfTheNext) {
  Counted counted;
  counted.missing.report(LossCause::dds_lost, 5, 0);
  counted.until(2 * kSecond_ns);
  counted.missing.begin_writer();
  counted.missing.gap(5, counted.now_ns);
  counted.until(4 * kSecond_ns);
  counted.close();
  EXPECT_EQ(counted.sum(), 10U);
}

/// Losses of random size and distance, each reported up to 4 s before or after its gap.
TEST(MissingSamples, TheSumOfRandomLossesIsTheNumberOfMissingTicks) {
  constexpr unsigned kSeed = 24;
  std::mt19937 random{kSeed};
  for (int run = 0; run < 200; ++run) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", run " + std::to_string(run));
    struct Step {
      bool is_gap;
      std::uint64_t samples;
    };
    std::multimap<std::int64_t, Step> steps;
    std::uint64_t lost = 0;
    for (int i = 0; i < 8; ++i) {
      const auto samples = std::uniform_int_distribution<std::uint64_t>{1, 50}(random);
      const auto at_ns = std::uniform_int_distribution<std::int64_t>{5 * kSecond_ns, 60 * kSecond_ns}(random);
      const auto later_ns =
          std::uniform_int_distribution<std::int64_t>{-4 * kSecond_ns, 4 * kSecond_ns}(random);
      steps.emplace(at_ns, Step{true, samples});
      steps.emplace(at_ns + later_ns, Step{false, samples});
      lost += samples;
    }
    Counted counted;
    for (const auto& [at_ns, step] : steps) {
      counted.until(at_ns);
      if (step.is_gap)
        counted.missing.gap(step.samples, at_ns);
      else
        counted.missing.report(LossCause::dds_lost, step.samples, at_ns);
    }
    counted.until(70 * kSecond_ns);
    counted.close();
    EXPECT_EQ(counted.sum(), lost);
  }
}

}  // namespace
}  // namespace crane::recorder
