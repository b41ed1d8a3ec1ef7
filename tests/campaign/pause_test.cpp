// A pause of the whole computer while the rig continues, and many requests in the same tick.
#include <gmock/gmock.h>
#include <spdlog/spdlog.h>

#include <cmath>

#include "campaign/hazards.hpp"
#include "campaign/judge/judge.hpp"

namespace crane::campaign {
namespace {

class Attacked : public testing::Test {
 protected:
  void SetUp() override { spdlog::set_level(spdlog::level::off); }
  void TearDown() override { spdlog::set_level(spdlog::level::info); }

  static bool braked(const Bench& bench) {
    const Row& row = bench.now();
    for (std::size_t i = 0; i < kAxes; ++i)
      if (bench.setting().configured.drives[i].present && !row.truth.brake_closed[i]) return false;
    return true;
  }
  /// Violations of the invariants that hold in every tick, whatever the reason of a stop.
  static void expect_safe(Bench& bench) {
    using enum Invariant;
    campaign::Run run{.begin_ns = bench.next_tick_ns(), .onset_ns = bench.next_tick_ns()};
    run.rows = bench.take_rows();
    for (const auto& violation : judge(bench.setting().configured, run).violations)
      for (const auto each : {inside_limits, braked_stays, reset_and_arm, volts_in_range})
        EXPECT_NE(violation.invariant, each) << violation.what << " at " << violation.time_ns << " ns";
  }
};

using Pause = Attacked;
using Requests = Attacked;

TEST_F(Pause, OfTenSecondsOfAllProcessesClosesTheBrakesByTheRelayAndMovesNothingAfterwards) {
  for (const auto moment : {Moment::armed_idle, Moment::peak_acceleration, Moment::cruise, Moment::stop}) {
    SCOPED_TRACE(std::string{name_of(moment)});
    Bench bench{setting(0, moment)};
    ASSERT_TRUE(bench.prepare(moment));
    const auto until_ns = bench.next_tick_ns() + 10'000'000'000;
    for (const auto source : {crane_SOURCE_PLANT, crane_SOURCE_PLANNER, crane_SOURCE_TRACKING,
                              crane_SOURCE_ANTI_SWING, crane_SOURCE_FRICTION, crane_SOURCE_SUPERVISOR})
      bench.stack().suspend(source, until_ns);
    bench.run(0.1);  // relay and coil
    EXPECT_TRUE(braked(bench));
    bench.run(9.8);
    const auto rested = bench.now().truth.position;
    for (double t_s = 0; t_s < 2; t_s += 0.01) {
      bench.tick();
      ASSERT_TRUE(braked(bench)) << t_s << " s after the end of the pause";
    }
    for (std::size_t i = 0; i < kAxes; ++i) EXPECT_NEAR(bench.now().truth.position[i], rested[i], 1e-3);
    EXPECT_EQ(bench.now().status.state, crane_STATE_LOCKED);
    EXPECT_NE(bench.now().status.cause, crane_CAUSE_NONE);
    bench.run(kClear_s);
    bench.request(crane_REQUEST_RESET);
    bench.run(kClear_s);
    bench.request(crane_REQUEST_ARM);
    EXPECT_TRUE(bench.run_until([&] { return bench.now().status.state == crane_STATE_HOLD; }, 2));
    expect_safe(bench);
  }
}

/// Up to four requests in one tick, also contradictory ones, at random times.
TEST_F(Requests, OfManyKindsInOneTickMoveNothingWithoutResetAndArm) {
  constexpr std::array kKinds{crane_REQUEST_RESET, crane_REQUEST_ARM,    crane_REQUEST_ARM,
                              crane_REQUEST_RESET, crane_REQUEST_STOP,   crane_REQUEST_HOME,
                              crane_REQUEST_ESTOP, crane_REQUEST_DISARM, crane_REQUEST_JOG,
                              crane_REQUEST_FOLLOW};
  std::size_t moved_ticks = 0;
  for (std::uint64_t seed = 500; seed < 505; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random{seed};
    Bench bench{setting(seed % kSettings, Moment::cruise)};
    bench.run(1.3);
    for (int k = 0; k < 60; ++k) {
      for (std::size_t n = random.pick(3); n > 0; --n) bench.send(kKinds.at(random.pick(kKinds.size())));
      stack::OperatorRequest wanted{
          .kind = crane_REQUEST_MOVE, .selected = bench.setting().selected, .target = bench.setting().target};
      if (random.chance(0.3)) wanted.target = bench.setting().configured.start.position;
      if (random.chance(0.5)) wanted.kind = kKinds.at(random.pick(4));
      bench.request(wanted);
      bench.run(random.chance(0.5) ? random.between(0, 0.3) : random.between(1, 1.5));
      moved_ticks += braked(bench) ? 0 : 1;
    }
    bench.request(crane_REQUEST_ESTOP);
    bench.run(0.2);
    EXPECT_TRUE(braked(bench));
    expect_safe(bench);
  }
  EXPECT_GT(moved_ticks, 20U);  // otherwise the requests never armed the crane
}

}  // namespace
}  // namespace crane::campaign
