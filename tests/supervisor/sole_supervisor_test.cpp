/// SoleSupervisor: of two supervisors that start together one ends, in every order of the samples.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <iostream>
#include <random>

#include "process/sole_supervisor.hpp"

namespace crane::supervisor {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::int64_t kSoleTick_ns = 10'000'000;
constexpr double kSoleTick_s = 1e-9 * kSoleTick_ns;
constexpr std::uint64_t kNewTicks = 500;  // 5 s

msg::SupervisorStatus sole_status(std::uint32_t epoch, crane_SupervisorState state = crane_STATE_LOCKED) {
  msg::SupervisorStatus status{};
  status.header.source = crane_SOURCE_SUPERVISOR;
  status.header.epoch = epoch;
  status.state = state;
  return status;
}
msg::NodeStatus sole_node(std::uint32_t epoch, std::uint64_t ticks,
                          crane_Source source = crane_SOURCE_SUPERVISOR) {
  msg::NodeStatus status{};
  status.header.source = source;
  status.header.epoch = epoch;
  status.phase = crane_PHASE_READY;
  status.ticks = ticks;
  status.pid = 123;
  std::ranges::copy(std::string_view{"fastdds"}, status.vendor);
  return status;
}
bus::WriterId sole_writer(std::uint8_t number) {
  bus::WriterId id{};
  id[0] = number;
  return id;
}

TEST(SoleSupervisor, IsNotDisputedByItsOwnSamplesAndThoseOfOtherProcesses) {
  SoleSupervisor sole{7, kSoleTick_s};
  sole.heard(sole_status(7), sole_writer(1), 0);
  sole.heard(sole_node(7, 1000));
  sole.heard(sole_node(1, 1000, crane_SOURCE_TRACKING));
  EXPECT_FALSE(sole.disputed(1));
  EXPECT_FALSE(sole.yields());
}

TEST(SoleSupervisor, WithTheLargerStartUpNumberExitsAndNamesTheRival) {
  SoleSupervisor smaller{3, kSoleTick_s}, larger{7, kSoleTick_s};
  smaller.heard(sole_status(7), sole_writer(2), 0);
  larger.heard(sole_status(3), sole_writer(1), 0);
  larger.heard(sole_node(3, 1));
  EXPECT_FALSE(smaller.yields());
  EXPECT_TRUE(larger.yields());
  EXPECT_THAT(larger.rival(), AllOf(HasSubstr("start-up number 3"), HasSubstr("process 123 (fastdds)")));
  EXPECT_TRUE(smaller.disputed(SoleSupervisor::kDispute_ns - 1));
  EXPECT_FALSE(smaller.disputed(SoleSupervisor::kDispute_ns));
}

TEST(SoleSupervisor, DoesNotEndBecauseOfAStatusThatEveryProcessMayWrite) {
  SoleSupervisor larger{7, kSoleTick_s};
  larger.heard(sole_node(3, kNewTicks + 1));
  EXPECT_FALSE(larger.yields());
  larger.heard(sole_status(5), sole_writer(2), 0);  // of another start-up number: a third program
  larger.heard(sole_node(3, kNewTicks + 1));
  EXPECT_FALSE(larger.yields());
  larger.heard(sole_status(3), sole_writer(1), 0);
  EXPECT_TRUE(larger.yields());
}

/// 600 ticks of 1 ms are less than the discovery of the other supervisor may take.
TEST(SoleSupervisor, WithAPeriodOf1msIsNewForFiveSecondsToo) {
  SoleSupervisor larger{7, 0.001};
  for (int tick = 0; tick < 600; ++tick) larger.stepped(crane_STATE_LOCKED);
  larger.heard(sole_status(3), sole_writer(1), 0);
  EXPECT_TRUE(larger.yields());
}

TEST(SoleSupervisor, IgnoresTheStatusOfASupervisorThatStops) {
  SoleSupervisor other{7, kSoleTick_s};
  auto stopping = sole_node(3, kNewTicks + 1);
  stopping.phase = crane_PHASE_STOPPING;
  other.heard(stopping);
  EXPECT_EQ(other.rival(), "");
}

TEST(SoleSupervisor, ThatMeetsAnEstablishedOneExitsWhateverItsStartUpNumber) {
  SoleSupervisor of_state{3, kSoleTick_s}, of_age{3, kSoleTick_s};
  of_state.heard(sole_status(7, crane_STATE_HOLD), sole_writer(2), 0);
  EXPECT_TRUE(of_state.yields());
  of_age.heard(sole_status(7), sole_writer(2), 0);
  EXPECT_FALSE(of_age.yields());
  of_age.heard(sole_node(7, kNewTicks + 1));
  EXPECT_TRUE(of_age.yields());
}

TEST(SoleSupervisor, ThatIsEstablishedNeverEndsButRefusesToMove) {
  SoleSupervisor after_reset{7, kSoleTick_s}, after_time{7, kSoleTick_s};
  after_reset.stepped(crane_STATE_READY);
  for (std::uint64_t tick = 0; tick <= kNewTicks; ++tick) after_time.stepped(crane_STATE_LOCKED);
  for (auto* sole : {&after_reset, &after_time}) {
    sole->heard(sole_status(3, crane_STATE_RUN), sole_writer(2), 0);
    sole->heard(sole_node(3, 100'000));
    EXPECT_FALSE(sole->yields());
    EXPECT_TRUE(sole->disputed(1));
  }
}

TEST(SoleSupervisor, IsDisputedByAnotherWriterWithItsOwnStartUpNumber) {
  SoleSupervisor sole{7, kSoleTick_s};
  sole.heard(sole_status(7), sole_writer(1), 0);
  sole.heard(sole_status(7), sole_writer(2), 0);
  EXPECT_TRUE(sole.disputed(1));
  EXPECT_FALSE(sole.yields());
}

/// A supervisor process in the simulation of the test below.
struct SoleProcess {
  SoleSupervisor sole;
  std::uint32_t epoch;
  int begins;     ///< tick of its first sample
  int reset_at;   ///< tick of its first reset
  int discovery;  ///< tick from which it receives samples of the other one
  int delay;      ///< age of the samples that it receives, in ticks
  bool ended = false;
  std::deque<msg::SupervisorStatus> sent{};
  std::deque<msg::NodeStatus> nodes{};
};

/// Two processes with random start-up numbers, starts up to 2 s apart, discovery within 3 s, delays up to
/// 1 s and resets at any time.
TEST(SoleSupervisor, NeverEndsTogetherWithTheOtherInRandomOrders) {
  constexpr unsigned kSeed = 4711;
  std::mt19937 random{kSeed};
  const auto pick = [&random](int low, int high) { return std::uniform_int_distribution{low, high}(random); };
  int one_remains = 0, both_refuse = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const auto make = [&] {
      const auto epoch = static_cast<std::uint32_t>(random()) | 1U;
      return SoleProcess{
          SoleSupervisor{epoch, kSoleTick_s}, epoch, pick(0, 200), pick(0, 1500), pick(0, 300), pick(0, 100)};
    };
    std::array both{make(), make()};
    for (int tick = 0; tick < 2000; ++tick)
      for (std::size_t i = 0; i < 2; ++i) {
        auto &me = both.at(i), &other = both.at(1 - i);
        if (me.ended || tick < me.begins) continue;
        if (tick >= me.discovery && other.sent.size() > static_cast<std::size_t>(me.delay)) {
          const auto at = other.sent.size() - 1 - static_cast<std::size_t>(me.delay);
          if (!other.ended)
            me.sole.heard(other.sent.at(at), sole_writer(static_cast<std::uint8_t>(2 - i)),
                          tick * kSoleTick_ns);
          if (!other.ended && at % 100 == 0) me.sole.heard(other.nodes.at(at));
        }
        if (me.sole.yields()) {
          me.ended = true;
          continue;
        }
        const bool reset = tick >= me.begins + me.reset_at && !me.sole.disputed(tick * kSoleTick_ns);
        const auto state = reset || (!me.sent.empty() && me.sent.back().state == crane_STATE_READY)
                               ? crane_STATE_READY
                               : crane_STATE_LOCKED;
        me.sole.stepped(state);
        me.sent.push_back(sole_status(me.epoch, state));
        me.nodes.push_back(sole_node(me.epoch, me.nodes.size()));
      }
    ASSERT_FALSE(both[0].ended && both[1].ended) << "seed " << kSeed << ", trial " << trial;
    if (both[0].ended || both[1].ended)
      ++one_remains;
    else if (both[0].sole.disputed(2000 * kSoleTick_ns) && both[1].sole.disputed(2000 * kSoleTick_ns))
      ++both_refuse;
    else
      FAIL() << "two supervisors and no dispute: seed " << kSeed << ", trial " << trial;
  }
  std::cout << "seed " << kSeed << ": one remains in " << one_remains << " trials, both refuse in "
            << both_refuse << '\n';
  EXPECT_GT(one_remains, 1000);
}

}  // namespace
}  // namespace crane::supervisor
