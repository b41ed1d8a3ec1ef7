/// Conditions under which samples of a stick act: every rule of docs/jog.md as a timeline. Tick k is at
/// k * 10 ms.
#include "process/jog_session.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "crane/runtime/node.hpp"

namespace crane::supervisor {
namespace {

using Verdict = JogSession::Verdict;
using Deflection = std::array<double, 3>;

constexpr JogWriter kOperator{{1}, {11}}, kStranger{{2}, {12}};
constexpr Deflection kReleased{};

class Jog : public testing::Test {
 protected:
  Jog() {
    request_.id = 7;
    request_.header.epoch = 4711;
    runtime::assign(request_.client, "crane 12");
    request_.selected[0] = request_.selected[1] = true;
  }
  [[nodiscard]] msg::Jog sample(std::uint64_t tick, const Deflection& deflection = {0.5, -0.25, 0.75}) const {
    msg::Jog jog{};
    jog.header.tick = tick;
    jog.header.epoch = request_.header.epoch;
    jog.request_id = request_.id;
    runtime::assign(jog.client, request_.client);
    jog.engaged = true;
    std::ranges::copy(deflection, jog.deflection);
    return jog;
  }
  /// The operator's request is accepted.
  void begin(double now_s) { session_.begin(request_, kOperator.participant, now_s); }
  Verdict take(const msg::Jog& jog, const JogWriter& from, std::uint64_t tick) {
    return session_.take(jog, from, tick, static_cast<double>(tick) / 100);
  }
  msg::Request request_{};
  JogSession session_{0.01};
};

TEST_F(Jog, ActsOnTheSelectedAxes) {
  begin(1);
  EXPECT_EQ(take(sample(100), kOperator, 101), Verdict::acts);
  EXPECT_EQ(session_.deflection(1.01), (Deflection{0.5, -0.25, 0}));
  EXPECT_TRUE(session_.active(1.01));
}

TEST_F(Jog, EndsWhenTheStickIsNotMovedForAMinute) {
  begin(1);
  std::uint64_t tick = 100;
  take(sample(tick), kOperator, tick);
  const auto active = [&] { return session_.active(static_cast<double>(tick) / 100); };
  for (; active() && tick < 10'000; ++tick) take(sample(tick, kReleased), kOperator, tick);
  EXPECT_NEAR(static_cast<double>(tick) / 100, 1 + JogSession::kLongest_s, 0.02);
  take(sample(tick), kOperator, tick);
  EXPECT_TRUE(active()) << "the operator is there again";
}

TEST_F(Jog, IgnoresAStrangerWithoutARequest) {
  EXPECT_EQ(take(sample(100), kStranger, 100), Verdict::stranger);
  EXPECT_EQ(session_.deflection(1), kReleased);
  EXPECT_FALSE(session_.active(1));
}

TEST_F(Jog, IgnoresEachOtherIdentity) {
  begin(1);
  auto other = sample(100);
  other.request_id = 8;
  EXPECT_EQ(take(other, kOperator, 100), Verdict::stranger);
  other = sample(100);
  other.header.epoch = 4712;
  EXPECT_EQ(take(other, kOperator, 100), Verdict::stranger);
  other = sample(100);
  runtime::assign(other.client, "crane 13");
  EXPECT_EQ(take(other, kOperator, 100), Verdict::stranger);
  EXPECT_EQ(session_.deflection(1), kReleased);
}

TEST_F(Jog, IgnoresASecondWriterThatCopiesTheWholeIdentity) {
  begin(1);
  EXPECT_EQ(take(sample(100), kOperator, 100), Verdict::acts);
  EXPECT_EQ(take(sample(100, {-1, -1, -1}), kStranger, 100), Verdict::stranger);
  EXPECT_EQ(session_.deflection(1), (Deflection{0.5, -0.25, 0}));
  auto release = sample(100);
  release.engaged = false;
  EXPECT_EQ(take(release, kStranger, 100), Verdict::stranger) << "a stranger cannot stop the session either";
  EXPECT_TRUE(session_.active(1));
}

TEST_F(Jog, ReleasesAfterAHundredMillisecondsOfSilence) {
  begin(1);
  take(sample(100), kOperator, 100);
  EXPECT_NE(session_.deflection(1.099), kReleased);
  EXPECT_EQ(session_.deflection(1.101), kReleased);
  EXPECT_FALSE(session_.active(1.101));
}

TEST_F(Jog, ReleasesWithTheDeadMansSwitch) {
  begin(1);
  take(sample(100), kOperator, 100);
  auto release = sample(101);
  release.engaged = false;
  EXPECT_EQ(take(release, kOperator, 101), Verdict::released);
  EXPECT_EQ(session_.deflection(1.01), kReleased);
  EXPECT_FALSE(session_.active(1.01));
}

TEST_F(Jog, ReleasesForADeflectionOutsideItsRange) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           1.0001, -1.0001, std::numeric_limits<double>::max()}) {
    begin(1);
    take(sample(100), kOperator, 100);
    EXPECT_EQ(take(sample(100, {0.5, bad, 0}), kOperator, 100), Verdict::released) << bad;
    EXPECT_EQ(session_.deflection(1), kReleased) << bad;
  }
}

TEST_F(Jog, ReleasesForASampleThatIsLateOrAheadOfTheClock) {
  begin(1);
  EXPECT_EQ(take(sample(100), kOperator, 110), Verdict::acts);
  EXPECT_EQ(take(sample(111), kOperator, 110), Verdict::released);
  EXPECT_EQ(take(sample(std::numeric_limits<std::uint64_t>::max()), kOperator, 110), Verdict::released);
  EXPECT_EQ(take(sample(100), kOperator, 111), Verdict::released);
}

TEST_F(Jog, WaitsHalfASecondForTheFirstSample) {
  begin(1);
  EXPECT_TRUE(session_.active(1.5));
  EXPECT_FALSE(session_.active(1.501));
}

TEST_F(Jog, EndsQuietlyForItsOperatorAndNotForOthers) {
  begin(1);
  take(sample(100), kOperator, 100);
  session_.end();
  EXPECT_EQ(take(sample(101), kOperator, 101), Verdict::ended);
  EXPECT_EQ(take(sample(101), kStranger, 101), Verdict::stranger);
  EXPECT_EQ(session_.deflection(1.01), kReleased);
}

TEST_F(Jog, BeginsANewSessionReleased) {
  begin(1);
  take(sample(100), kOperator, 100);
  ++request_.id;
  begin(1.01);
  EXPECT_EQ(session_.deflection(1.01), kReleased);
}

TEST_F(Jog, BelongsToTheParticipantOfTheRequestAndNotToTheFirstWriter) {
  begin(1);
  EXPECT_EQ(take(sample(100), kStranger, 100), Verdict::stranger);
  EXPECT_EQ(session_.deflection(1), kReleased);
  EXPECT_EQ(take(sample(101), kOperator, 101), Verdict::acts);
}

TEST_F(Jog, HasOneWriterEvenOfItsOwnParticipant) {
  begin(1);
  EXPECT_EQ(take(sample(100), kOperator, 100), Verdict::acts);
  EXPECT_EQ(take(sample(100), {kOperator.participant, {13}}, 100), Verdict::stranger)
      << "a participant that copies the identifier of another one has a writer of its own";
}

TEST_F(Jog, OfAnUnknownParticipantNeverActs) {
  session_.begin(request_, bus::kUnknownParticipant, 1);
  EXPECT_EQ(take(sample(100), kOperator, 100), Verdict::stranger);
  EXPECT_EQ(take(sample(100), {bus::kUnknownParticipant, {11}}, 100), Verdict::stranger);
}

TEST_F(Jog, OfANewRequestBelongsToItsOwnParticipant) {
  begin(1);
  take(sample(100), kOperator, 100);
  session_.begin(request_, kStranger.participant, 1.01);
  EXPECT_EQ(take(sample(101), kOperator, 101), Verdict::stranger);
  EXPECT_EQ(take(sample(101), kStranger, 101), Verdict::acts);
}

/// The stick is deflected, then one of the faults occurs; the operator's samples then continue.
class FaultyStick : public Jog {
 protected:
  FaultyStick() {
    begin(1);
    take(sample(100), kOperator, 100);
  }
  void expect_released_until_the_operator_releases(std::uint64_t tick) {
    EXPECT_EQ(take(sample(tick), kOperator, tick), Verdict::released) << "motion does not begin by itself";
    EXPECT_FALSE(session_.active(static_cast<double>(tick) / 100));
    EXPECT_EQ(take(sample(tick + 1), kOperator, tick + 1), Verdict::released);
    auto release = sample(tick + 2);
    release.engaged = false;
    EXPECT_EQ(take(release, kOperator, tick + 2), Verdict::released);
    EXPECT_EQ(take(sample(tick + 3), kOperator, tick + 3), Verdict::acts);
  }
};

TEST_F(FaultyStick, AfterASilenceHasToBeReleasedFirst) { expect_released_until_the_operator_releases(111); }

TEST_F(FaultyStick, AfterASilenceThatALateSampleEndsHasToBeReleasedFirst) {
  take(sample(100), kOperator, 120);
  expect_released_until_the_operator_releases(121);
}

TEST_F(FaultyStick, AfterASilenceThatAnEarlySampleEndsHasToBeReleasedFirst) {
  take(sample(500), kOperator, 120);
  expect_released_until_the_operator_releases(121);
}

TEST_F(FaultyStick, WithADelayedSampleHasToBeReleasedFirst) {
  take(sample(91), kOperator, 102);
  expect_released_until_the_operator_releases(103);
}

TEST_F(FaultyStick, WithADeflectionOutsideItsRangeHasToBeReleasedFirst) {
  take(sample(101, {2, 0, 0}), kOperator, 101);
  expect_released_until_the_operator_releases(102);
}

TEST_F(FaultyStick, ThatIsDeflectedForAMinuteHasToBeReleasedFirst) {
  std::uint64_t tick = 100;
  while (take(sample(tick), kOperator, tick) == Verdict::acts) ++tick;
  EXPECT_NEAR(static_cast<double>(tick) / 100, 1 + JogSession::kLongest_s, 0.02);
  expect_released_until_the_operator_releases(tick);
}

TEST_F(FaultyStick, IsReleasedWhenItsDeflectionReturnsToZero) {
  EXPECT_EQ(take(sample(120), kOperator, 120), Verdict::released);
  EXPECT_EQ(take(sample(121, {0, 0, 1}), kOperator, 121), Verdict::acts) << "the third axis is not selected";
  EXPECT_EQ(take(sample(122), kOperator, 122), Verdict::acts);
}

}  // namespace
}  // namespace crane::supervisor
