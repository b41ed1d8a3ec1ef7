// Axes without known position: refused requests, phases of homing, and all failures of homing.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "timeline.hpp"

namespace crane::supervisor {
namespace {

constexpr double kMark_m = 0.1;

Limits homing_limits() {
  Limits limits = test_limits();
  limits.axis[0].zero = control::Zero::homing;
  limits.axis[0].homing = {.mark = control::Mark::limit_low,
                           .position = kMark_m,
                           .speed = 0.05,
                           .approach_speed = 0.01,
                           .back_off = 0.02,
                           .volt_limit_v = 4};
  return limits;
}

/// A trolley that follows the creeping reference, its limit switches, and a bridge that knows the position
/// after two detections of the mark and the closing of the brake.
class HomingTimeline : public Timeline {
 public:
  explicit HomingTimeline(double from_m = 0.3) : Timeline{homing_limits()}, true_m{from_m} {
    world.sample.position[0] = 1.4;
    world.sample.position_unknown[0] = true;
  }

  double true_m, follows = 1;
  bool stuck_closed = false, never_closes = false, bridge_agrees = true, mirrored = false;

  void run_with_motion(double seconds) {
    for (int i = 0; i < std::lround(seconds / limits.period_s); ++i) run_a_tick();
  }
  /// @return seconds until the crane was stopped, at most `longest_s`
  double run_until_stopped(double longest_s = 60) {
    for (double passed_s = 0; passed_s < longest_s; passed_s += limits.period_s) {
      if (state() >= State::stop_c1 || state() == State::locked) return passed_s;
      run_a_tick();
    }
    return longest_s;
  }
  Answer home(std::size_t axis = 0) {
    world.home_axis = axis;
    return ask(Request::home);
  }
  void to_homing() {
    to_ready();
    run(0.1);
    EXPECT_TRUE(home().accepted);
    for (int i = 0; i < 50 && state() == State::arming; ++i) run_with_motion(limits.period_s);
    EXPECT_EQ(state(), State::run);
  }
  [[nodiscard]] bool known() const { return !world.sample.position_unknown[0]; }
  [[nodiscard]] int mark_detections() const { return mark_detections_; }

 private:
  void run_a_tick() {
    Sample& sample = world.sample;
    speed[0] = follows * out.homing_speed[0];
    if (!sample.brake_closed[0]) true_m += (mirrored ? -speed[0] : speed[0]) * limits.period_s;
    const bool closed = stuck_closed || (!never_closes && true_m <= kMark_m);
    mark_detections_ += closed && !sample.mark_active[0] ? 1 : 0;
    sample.mark_active[0] = sample.limit_low[0] = closed;
    sample.limit_high[0] = true_m >= 1.4;
    sample.mark_found[0] = bridge_agrees && mark_detections_ >= 2 && sample.position_unknown[0];
    if (out.homing[0] && !was_homing_) sample.position_unknown[0] = true;
    was_homing_ = out.homing[0];
    if (out.homing[0] && sample.mark_found[0] && sample.brake_closed[0] && !closed) {
      sample.position[0] = true_m;
      sample.position_unknown[0] = sample.mark_found[0] = false;
    }
    tick();
    EXPECT_FALSE(out.brake_release[1]) << "only the axis that is homed";
    EXPECT_EQ(out.drive_v[1], 0);
    EXPECT_LE(std::abs(out.drive_v[0]), limits.axis[0].homing.volt_limit_v);
  }
  int mark_detections_ = 0;
  bool was_homing_ = false;
};

TEST(HomingLimits, AreCheckedWithTheOthers) {
  Limits limits = homing_limits();
  EXPECT_TRUE(problems(limits).empty());
  limits.axis[0].homing.speed = 0.005;  // below that of the approach
  limits.axis[0].homing.position = 2;
  limits.axis[0].homing.back_off = 0;
  EXPECT_EQ(problems(limits).size(), 3U);
}

TEST(Homing, WithAnUnknownPositionArmingAndMovingAreRefusedWithTheRemedy) {  // S21
  HomingTimeline t;
  t.to_ready();
  t.run(0.1);
  for (const Answer& answer : {t.arm(), t.move()}) {
    EXPECT_FALSE(answer.accepted);
    EXPECT_NE(std::string_view{answer.reason}.find("crane home --axis trolley"), std::string_view::npos);
  }
  EXPECT_EQ(t.state(), State::ready);
  EXPECT_TRUE(t.safe());
}

TEST(Homing, OfAnAxisWithoutAMarkOrOfAnArmedCraneIsRefused) {
  HomingTimeline t;
  t.to_locked();
  EXPECT_FALSE(t.home().accepted) << "reset first";
  t.reset();
  const Answer of_slew = t.home(1);
  EXPECT_FALSE(of_slew.accepted);
  EXPECT_NE(std::string_view{of_slew.reason}.find("[homing.slew]"), std::string_view::npos) << of_slew.reason;
  t.world.sample.position_unknown[0] = false;
  t.run(0.2);
  t.arm();
  t.run(0.5);
  ASSERT_EQ(t.state(), State::hold);
  EXPECT_FALSE(t.home().accepted);
  EXPECT_EQ(t.state(), State::hold);
}

TEST(Homing, FindsTheMarkTwiceAndEndsLockedWithAKnownPosition) {  // S22
  for (const double from_m :
       {0.3, 0.105, 0.08, 1.4}) {  // the third run starts at the mark, the last run at the other switch
    HomingTimeline t{from_m};
    t.to_homing();
    t.demand(9);  // limited to volt_limit_v of [homing]
    t.run_until_stopped();
    EXPECT_EQ(t.cause(), Cause::homed) << from_m;
    t.run_with_motion(0.5);
    EXPECT_EQ(t.state(), State::locked) << name_of(t.cause());
    EXPECT_TRUE(t.safe());
    EXPECT_TRUE(t.known());
    EXPECT_EQ(t.mark_detections(), from_m < kMark_m ? 3 : 2);
    EXPECT_NEAR(t.true_m, kMark_m + 0.02, 0.005) << "off the mark";
    t.demand(0);
    t.run(1.1);
    EXPECT_TRUE(t.reset().accepted);
    t.run(0.1);
    EXPECT_TRUE(t.arm().accepted);
    t.run(0.5);
    EXPECT_EQ(t.state(), State::hold) << name_of(t.cause());
  }
}

TEST(Homing, CreepsBackAndApproachesSlowly) {
  HomingTimeline t;
  t.to_homing();
  std::vector<double> speeds;
  while (t.state() == State::run) {
    t.run_with_motion(0.01);
    const double speed = t.out.homing_speed[0];
    if (speed != 0 && (speeds.empty() || speeds.back() != speed)) speeds.push_back(speed);
  }
  EXPECT_EQ(speeds, (std::vector<double>{-0.05, 0.05, -0.01, 0.05}));
}

struct Failure {
  const char* name;
  std::function<void(HomingTimeline&)> begin;
  HomingFailure expected;
  double longest_s;
  double from_m = 0.3;
  friend std::ostream& operator<<(std::ostream& out, const Failure& failure) { return out << failure.name; }
};

class FailedHoming : public ::testing::TestWithParam<Failure> {};

TEST_P(FailedHoming, RemovesPowerAndReportsItsReasonAndAnUnknownPosition) {  // S23
  const auto& failure = GetParam();
  HomingTimeline t{failure.from_m};
  failure.begin(t);
  t.to_homing();
  EXPECT_LE(t.run_until_stopped(), failure.longest_s);
  EXPECT_EQ(t.state(), State::stop_c0);
  EXPECT_EQ(t.cause(), Cause::homing_failed);
  EXPECT_EQ(t.out.homing_failure, failure.expected) << name_of(t.out.homing_failure);
  EXPECT_STRNE(remedy_for(t.out.homing_failure), "");
  EXPECT_TRUE(t.safe());
  t.run_with_motion(1.5);
  EXPECT_EQ(t.state(), State::locked);
  EXPECT_FALSE(t.known());
  t.reset();
  t.run(0.1);
  EXPECT_FALSE(t.arm().accepted);
}

INSTANTIATE_TEST_SUITE_P(
    Each, FailedHoming,
    ::testing::Values(
        Failure{"TheSwitchNeverCloses", [](HomingTimeline& c) { c.never_closes = true; },
                HomingFailure::mark_not_found, 30},
        Failure{"TheSwitchIsStuckClosed", [](HomingTimeline& c) { c.stuck_closed = true; },
                HomingFailure::mark_stuck, 2},
        Failure{"BothSwitchesAreClosed",
                [](HomingTimeline& c) {
                  c.stuck_closed = true;
                  c.true_m = 1.4;
                },
                HomingFailure::mark_stuck, 0.1},
        // Wrong signs of drive and encoder: the loop is stable, and the axis moves in the other direction.
        Failure{"TheOtherSwitchIsReached", [](HomingTimeline& c) { c.mirrored = true; },
                HomingFailure::other_switch, 3, 1.35},
        Failure{"TheAxisDoesNotFollow", [](HomingTimeline& c) { c.follows = 0; }, HomingFailure::no_motion,
                2},
        Failure{"TheAxisGoesTheWrongWay", [](HomingTimeline& c) { c.follows = -0.2; },
                HomingFailure::no_motion, 5},
        Failure{"TheBridgeFindsTwoPositions", [](HomingTimeline& c) { c.bridge_agrees = false; },
                HomingFailure::mark_disagrees, 30}),
    [](const auto& test) { return std::string{test.param.name}; });

TEST(Homing, InterruptedByAStopOrTheEmergencyStopLeavesThePositionUnknown) {
  const std::pair<Request, Cause> interruptions[] = {{Request::stop, Cause::operator_stop},
                                                     {Request::disarm, Cause::operator_disarm},
                                                     {Request::estop, Cause::operator_estop}};
  for (const auto& [request, cause] : interruptions) {
    HomingTimeline t;
    t.to_homing();
    t.run_with_motion(1);
    t.ask(request);
    t.run_with_motion(2);
    EXPECT_EQ(t.cause(), cause);
    EXPECT_TRUE(t.safe());
    EXPECT_FALSE(t.known());
    EXPECT_FALSE(t.out.homing[0]);
  }
}

TEST(Homing, AnAxisThatDoesNotCreepIsStopped) {
  HomingTimeline t;
  t.to_homing();
  t.follows = 3;
  t.run_with_motion(0.03);
  EXPECT_EQ(t.state(), State::stop_c0);
  EXPECT_EQ(t.cause(), Cause::overspeed);
}

TEST(Homing, MovingWhileAnAxisIsHomedIsRefused) {
  HomingTimeline t;
  t.to_homing();
  EXPECT_FALSE(t.ask(Request::move).accepted);
  EXPECT_FALSE(t.arm().accepted);
  EXPECT_EQ(t.state(), State::run);
}

TEST(Homing, APositionThatBecomesUnknownWhileArmedStopsTheCrane) {  // S24
  Timeline t{homing_limits()};
  t.to_run();
  ASSERT_EQ(t.state(), State::run);
  t.world.sample.position_unknown[0] = true;
  t.tick();
  EXPECT_EQ(t.state(), State::stop_c0);
  EXPECT_EQ(t.cause(), Cause::not_homed);
  EXPECT_TRUE(t.safe());
}

}  // namespace
}  // namespace crane::supervisor
