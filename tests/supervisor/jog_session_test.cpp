/// Which samples of a stick act: every hazard of docs/jog.md as a timeline. The period is 10 ms, tick k is at
/// k / 100 s.
#include "process/jog_session.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "crane/runtime/node.hpp"

namespace crane::supervisor {
namespace {

using Verdict = JogSession::Verdict;
using Deflection = std::array<double, 3>;

constexpr bus::WriterId kOperator{1}, kStranger{2};
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
  Verdict take(const msg::Jog& jog, const bus::WriterId& writer, std::uint64_t tick) {
    return session_.take(jog, writer, tick, static_cast<double>(tick) / 100);
  }
  msg::Request request_{};
  JogSession session_{0.01};
};

TEST_F(Jog, ActsOnTheSelectedAxes) {
  session_.begin(request_, 1);
  EXPECT_EQ(take(sample(100), kOperator, 101), Verdict::acts);
  EXPECT_EQ(session_.deflection(1.01), (Deflection{0.5, -0.25, 0}));
  EXPECT_TRUE(session_.held(1.01));
}

TEST_F(Jog, IgnoresAStrangerWithoutARequest) {
  EXPECT_EQ(take(sample(100), kStranger, 100), Verdict::stranger);
  EXPECT_EQ(session_.deflection(1), kReleased);
  EXPECT_FALSE(session_.held(1));
}

TEST_F(Jog, IgnoresEachOtherIdentity) {
  session_.begin(request_, 1);
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
  session_.begin(request_, 1);
  EXPECT_EQ(take(sample(100), kOperator, 100), Verdict::acts);
  EXPECT_EQ(take(sample(100, {-1, -1, -1}), kStranger, 100), Verdict::stranger);
  EXPECT_EQ(session_.deflection(1), (Deflection{0.5, -0.25, 0}));
  auto release = sample(100);
  release.engaged = false;
  EXPECT_EQ(take(release, kStranger, 100), Verdict::stranger) << "a stranger cannot stop the session either";
  EXPECT_TRUE(session_.held(1));
}

TEST_F(Jog, ReleasesAfterAHundredMillisecondsOfSilence) {
  session_.begin(request_, 1);
  take(sample(100), kOperator, 100);
  EXPECT_NE(session_.deflection(1.099), kReleased);
  EXPECT_EQ(session_.deflection(1.101), kReleased);
  EXPECT_FALSE(session_.held(1.101));
}

TEST_F(Jog, ReleasesWithTheDeadMansSwitch) {
  session_.begin(request_, 1);
  take(sample(100), kOperator, 100);
  auto release = sample(101);
  release.engaged = false;
  EXPECT_EQ(take(release, kOperator, 101), Verdict::released);
  EXPECT_EQ(session_.deflection(1.01), kReleased);
  EXPECT_FALSE(session_.held(1.01));
}

TEST_F(Jog, ReleasesForAValueThatIsNoShare) {
  session_.begin(request_, 1);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1.0001, -1.0001}) {
    take(sample(100), kOperator, 100);
    EXPECT_EQ(take(sample(100, {0.5, bad, 0}), kOperator, 100), Verdict::released) << bad;
    EXPECT_EQ(session_.deflection(1), kReleased) << bad;
  }
}

TEST_F(Jog, ReleasesForASampleThatIsLateOrAheadOfTheClock) {
  session_.begin(request_, 1);
  EXPECT_EQ(take(sample(100), kOperator, 110), Verdict::acts);
  EXPECT_EQ(take(sample(100), kOperator, 111), Verdict::released);
  EXPECT_EQ(take(sample(113), kOperator, 112), Verdict::released);
}

TEST_F(Jog, WaitsHalfASecondForTheFirstSample) {
  session_.begin(request_, 1);
  EXPECT_TRUE(session_.held(1.5));
  EXPECT_FALSE(session_.held(1.501));
}

TEST_F(Jog, EndsQuietlyForItsOperatorAndNotForOthers) {
  session_.begin(request_, 1);
  take(sample(100), kOperator, 100);
  session_.end();
  EXPECT_EQ(take(sample(101), kOperator, 101), Verdict::ended);
  EXPECT_EQ(take(sample(101), kStranger, 101), Verdict::stranger);
  EXPECT_EQ(session_.deflection(1.01), kReleased);
}

TEST_F(Jog, BeginsANewSessionReleased) {
  session_.begin(request_, 1);
  take(sample(100), kOperator, 100);
  ++request_.id;
  session_.begin(request_, 1.01);
  EXPECT_EQ(session_.deflection(1.01), kReleased);
  EXPECT_EQ(take(sample(101), kStranger, 101), Verdict::acts) << "another writer may begin another session";
}

}  // namespace
}  // namespace crane::supervisor
