/// The planner component executes the accepted move and nothing else.
#include <gtest/gtest.h>

#include <cmath>

#include "../runtime/component_bench.hpp"
#include "trajectory_planner/trajectory_planner.hpp"

namespace crane::services {
namespace {

using runtime::test::ComponentBench;
using runtime::test::state_at;

class PlannerComponent : public testing::Test {
 protected:
  explicit PlannerComponent(runtime::Clock clock = runtime::Clock::lockstep,
                            const configuration::Rig& rig = runtime::test::tower())
      : bench_{trajectory_planner_spec(), rig, "gain_scheduling_partial", clock} {}

  /// Runs one tick in `state_` with `move_` as the last accepted move. @return the reference of the next tick
  [[nodiscard]] msg::Reference tick() {
    ++tick_;
    msg::SupervisorStatus status{};
    status.header = runtime::test::tick(tick_);
    status.state = state_;
    status.move = move_;
    auto state = state_at(tick_);
    state.trolley_position_m += pushed_m_;
    bench_.publish(topics::state, crane_SOURCE_PLANT, state);
    bench_.publish(topics::supervisor, crane_SOURCE_SUPERVISOR, status);
    bench_.step();
    return newest();
  }
  [[nodiscard]] msg::Reference newest() {
    const auto newest = newest_if_any();
    if (!newest) throw std::runtime_error{"no reference"};
    return *newest;
  }
  [[nodiscard]] std::optional<msg::Reference> newest_if_any() {
    std::optional<msg::Reference> newest;
    while (const auto sample = output_.take()) newest = sample;
    return newest;
  }
  /// In the tick of the acceptance the supervisor is in RUN.
  void accept(std::uint64_t number, double trolley_m) {
    state_ = crane_STATE_RUN;
    move_ = {};
    move_.number = number;
    move_.kind = crane_REQUEST_MOVE;
    move_.selected[0] = true;
    move_.target[0] = trolley_m;
  }
  ComponentBench bench_;
  bus::Subscriber<msg::Reference> output_ = bench_.listen(topics::reference);
  crane_SupervisorState state_ = crane_STATE_HOLD;
  msg::AcceptedMove move_{};
  std::uint64_t tick_ = 0;
  double pushed_m_ = 0;  ///< change of the position of the trolley
};

TEST_F(PlannerComponent, PublishesTheReferenceOfTheNextTick) {
  EXPECT_EQ(tick().header.tick, 2u);
  EXPECT_EQ(tick().header.tick, 3u);
}

TEST_F(PlannerComponent, BeginsAtThePositionOfACraneThatIsAlreadyArmed) {
  const auto first = tick();
  EXPECT_EQ(first.axis[0].position, 0.5);
  EXPECT_EQ(first.axis[1].position, 0.2);
  EXPECT_EQ(first.axis[2].position, 1);
}

TEST_F(PlannerComponent, ExecutesANewMoveOnce) {
  (void)tick();
  accept(1, 0.9);
  const auto moving = tick();
  EXPECT_EQ(moving.axis[0].position, 0.9);
  EXPECT_EQ(moving.move_number, 1u);
  EXPECT_TRUE(moving.moving);
  state_ = crane_STATE_LOCKED;
  EXPECT_EQ(tick().axis[0].position, 0.5) << "the reference of a locked crane is its position";
  state_ = crane_STATE_HOLD;
  EXPECT_EQ(tick().axis[0].position, 0.5) << "an old move is not executed again";
}

/// Otherwise the supervisor would change from HOLD to RUN without a move.
TEST_F(PlannerComponent, DoesNotBeginACompletedMoveAgainWhenTheCraneIsPushedAway) {
  (void)tick();
  accept(1, 0.55);
  EXPECT_TRUE(tick().moving);
  pushed_m_ = 0.05;
  for (int settling = 0; settling < 50; ++settling) (void)tick();  // the measured speed is filtered
  EXPECT_FALSE(tick().moving);
  pushed_m_ = 0.1;
  for (int settling = 0; settling < 50; ++settling) EXPECT_FALSE(tick().moving);
  accept(2, 0.5);
  EXPECT_TRUE(tick().moving);
}

TEST_F(PlannerComponent, DoesNotExecuteAMoveThatItReceivesAfterAStop) {
  (void)tick();
  accept(1, 0.9);
  for (const auto state : {crane_STATE_STOP_C1, crane_STATE_LOCKED, crane_STATE_READY, crane_STATE_ARMING,
                           crane_STATE_HOLD, crane_STATE_RUN}) {
    state_ = state;
    const auto reference = tick();
    EXPECT_EQ(reference.axis[0].position, 0.5) << "state " << state;
    EXPECT_EQ(reference.move_number, 0u);
  }
  accept(2, 0.7);
  EXPECT_EQ(tick().axis[0].position, 0.7);
}

TEST_F(PlannerComponent, DoesNotExecuteAMoveThatItReceivesAfterTheSupervisorHasLeftRun) {
  (void)tick();
  accept(1, 0.9);
  state_ = crane_STATE_HOLD;
  EXPECT_EQ(tick().axis[0].position, 0.5);
  state_ = crane_STATE_RUN;
  EXPECT_EQ(tick().axis[0].position, 0.5);
}

TEST_F(PlannerComponent, DoesNotExecuteAMoveThatWasAcceptedBeforeItsFirstTick) {
  accept(5, 0.9);
  EXPECT_EQ(tick().axis[0].position, 0.5);
  EXPECT_EQ(tick().axis[0].position, 0.5);
}

TEST_F(PlannerComponent, StopsWhereTheCraneIsInAControlledStop) {
  (void)tick();
  accept(1, 0.9);
  (void)tick();
  state_ = crane_STATE_STOP_C1;
  const auto stopped = tick();
  EXPECT_NEAR(stopped.axis[0].position, 0.5, 1e-9) << "the crane of this test stands still";
}

class PlannerAroundZones : public PlannerComponent {
 protected:
  PlannerAroundZones()
      : PlannerComponent{runtime::Clock::lockstep,
                         configuration::load_rig(CRANE_RIGS "/virginia_tech_tower_silo.toml")} {}
};

TEST_F(PlannerAroundZones, ReportsAMoveAsExecutedFromItsBeginningOn) {
  (void)tick();
  accept(1, 0.6);
  EXPECT_EQ(tick().move_number, 1u) << "the crane rests: the move begins at once";
}

TEST_F(PlannerAroundZones, DoesNotReportAMoveAsExecutedWithoutAPathToItsTarget) {
  (void)tick();
  accept(1, 0.7);
  move_.selected[1] = true;
  move_.target[1] = 1.0;  // inside the silo: the supervisor would refuse this target
  const auto reference = tick();
  EXPECT_EQ(reference.move_number, 0u) << "`crane move --wait` would report success";
  EXPECT_FALSE(reference.moving);
}

class PlannerInRealTime : public PlannerComponent {
 protected:
  PlannerInRealTime() : PlannerComponent{runtime::Clock::realtime} {}

  /// Runs one tick in which no status of the supervisor arrives.
  [[nodiscard]] std::optional<msg::Reference> tick_without_status() {
    bench_.publish(topics::state, crane_SOURCE_PLANT, state_at(++tick_));
    bench_.step();
    bench_.step_after(9'000'000);
    return newest_if_any();
  }
  void lose_the_supervisor() {
    for (int k = 0; k < 5; ++k) (void)tick_without_status();
  }
};

TEST_F(PlannerInRealTime, ExecutesAMoveWhoseFirstStatusIsLost) {
  (void)tick();
  accept(1, 0.9);
  (void)tick_without_status();
  EXPECT_EQ(tick().axis[0].position, 0.9);
}

TEST_F(PlannerInRealTime, DoesNotExecuteAMoveThatItReceivesAfterALongGapOfTheStatus) {
  (void)tick();
  accept(1, 0.9);
  lose_the_supervisor();
  state_ = crane_STATE_LOCKED;
  EXPECT_EQ(tick().axis[0].position, 0.5);
  state_ = crane_STATE_RUN;
  EXPECT_EQ(tick().axis[0].position, 0.5);
}

/// Without a reference there is no demand, and the supervisor stops the crane. A reference that followed the
/// measured position would end the move as if its target were reached, and would hold no armed crane.
TEST_F(PlannerInRealTime, WithholdsTheReferenceWithoutSupervisorUntilTheCraneHasStopped) {
  for (const auto armed : {crane_STATE_LOCKED, crane_STATE_ARMING, crane_STATE_HOLD, crane_STATE_RUN}) {
    state_ = armed;
    (void)tick();
    lose_the_supervisor();
    EXPECT_FALSE(tick_without_status()) << "state " << armed;
    state_ = crane_STATE_HOLD;
    EXPECT_THROW((void)tick(), std::runtime_error) << "state " << armed;
    state_ = crane_STATE_LOCKED;
    EXPECT_EQ(tick().axis[0].position, 0.5) << "state " << armed;
  }
}

TEST_F(PlannerInRealTime, PublishesThePositionOfTheCraneBeforeItHearsASupervisor) {
  lose_the_supervisor();
  const auto reference = tick_without_status();
  ASSERT_TRUE(reference);
  EXPECT_EQ(reference->axis[0].position, 0.5);
}

TEST_F(PlannerInRealTime, ContinuesAControlledStopWithoutSupervisor) {
  state_ = crane_STATE_STOP_C1;
  (void)tick();
  lose_the_supervisor();
  const auto reference = tick_without_status();
  ASSERT_TRUE(reference);
  EXPECT_NEAR(reference->axis[0].position, 0.5, 1e-9) << "the crane of this test stands still";
}

TEST_F(PlannerComponent, DoesNotExecuteAMoveWhoseTargetIsOutsideTheLimits) {
  (void)tick();
  std::uint64_t number = 0;
  for (const double target : {std::nan(""), 1e300, -5.0}) {
    accept(++number, target);
    EXPECT_EQ(tick().axis[0].position, 0.5) << target;
  }
}

}  // namespace
}  // namespace crane::services
