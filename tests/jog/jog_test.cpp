/// The stick in closed loop: operator, supervisor, planner, controllers and the simulated tower crane.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "operated_crane.hpp"

namespace crane::jog_test {
namespace {

using Deflection = std::array<double, 3>;

constexpr double kToDegree = 180 / std::numbers::pi;

/// An armed crane with an operator who sends a sample per tick.
class Jogged {
 public:
  explicit Jogged(const std::string& controller, const std::string& rig = "virginia_tech_tower")
      : crane_{controller, configuration::load_rig(CRANE_RIGS "/" + rig + ".toml")},
        jogs_{crane_.bus().publisher(topics::jog)},
        events_{crane_.bus().subscriber(topics::event)} {
    crane_.every_tick = [this] { after_tick(); };
  }
  [[nodiscard]] std::string begin(const std::array<bool, 3>& selected) {
    msg::Request request{};
    request.kind = crane_REQUEST_JOG;
    std::ranges::copy(selected, request.selected);
    const auto reason = crane_.ask(request);
    id_ = crane_.last_id();
    return reason;
  }
  void deflect(const Deflection& deflection, double seconds) {
    stick_ = deflection;
    crane_.run(seconds);
  }
  /// Releases the stick. @return seconds until HOLD
  double release() {
    stick_ = Deflection{};
    engaged_ = false;
    return crane_.run_until_hold(20);
  }
  /// The operator's program ends without a release.
  void die() { stick_.reset(); }
  [[nodiscard]] msg::Jog sample(const Deflection& deflection) const {
    msg::Jog jog{};
    jog.header.tick = crane_.state().header.tick;
    jog.request_id = id_;
    runtime::assign(jog.client, kClient);
    jog.engaged = engaged_;
    std::ranges::copy(deflection, jog.deflection);
    return jog;
  }
  /// Largest swing in the next seconds.
  double largest_swing_deg(double seconds) {
    largest_rad_ = 0;
    crane_.run(seconds);
    return largest_rad_ * kToDegree;
  }
  [[nodiscard]] int events(std::string_view code) {
    while (const auto event = events_.take()) codes_.emplace_back(event->code);
    return static_cast<int>(std::ranges::count(codes_, code));
  }
  [[nodiscard]] OperatedCrane& crane() { return crane_; }
  std::function<void()> mischief = [] {};

 private:
  void after_tick() {
    largest_rad_ = std::max(largest_rad_,
                            std::hypot(crane_.state().swing_radial_rad, crane_.state().swing_tangential_rad));
    ASSERT_TRUE(!stick_ || jogs_.publish(sample(*stick_)));
    mischief();
  }
  OperatedCrane crane_;
  bus::Publisher<msg::Jog> jogs_;
  bus::Subscriber<msg::Event> events_;
  std::optional<Deflection> stick_;
  bool engaged_ = true;
  std::uint64_t id_ = 0;
  double largest_rad_ = 0;
  std::vector<std::string> codes_;
};

struct Loop {
  const char* controller;
  double most_deg;  ///< swing later than two periods after the release
};

class EveryController : public testing::TestWithParam<Loop> {};

TEST_P(EveryController, FollowsTheStickAndEndsInHold) {
  Jogged jogged{GetParam().controller};
  ASSERT_EQ(jogged.begin({true, true, false}), "");
  const double from_m = jogged.crane().state().trolley_position_m,
               from_rad = jogged.crane().state().slew_angle_rad;
  jogged.deflect({1, 0.6, 0}, 2.5);
  EXPECT_EQ(jogged.crane().status().state, crane_STATE_RUN);
  EXPECT_GT(jogged.crane().state().trolley_position_m - from_m, 0.2);
  EXPECT_GT(jogged.crane().state().slew_angle_rad - from_rad, 0.1);
  const double stop_s = jogged.release();
  EXPECT_LT(stop_s, 10);
  EXPECT_EQ(jogged.crane().status().state, crane_STATE_HOLD) << jogged.crane().cause();
  jogged.crane().run(std::max(0.0, 4 - stop_s));
  const double residual_deg = jogged.largest_swing_deg(2);
  std::cout << GetParam().controller << ": HOLD after " << stop_s << " s, swing from 4 s on " << residual_deg
            << " deg\n";
  EXPECT_LT(residual_deg, GetParam().most_deg);
}

INSTANTIATE_TEST_SUITE_P(Jog, EveryController,
                         testing::Values(Loop{"time_optimal", 0.5}, Loop{"lqr", 0.5}, Loop{"delayed_1", 0.5},
                                         Loop{"shaped_zv", 0.8}),
                         [](const auto& loop) { return std::string{loop.param.controller}; });

TEST(Jog, IsRefusedUnlessTheCraneIsArmed) {
  Jogged jogged{"lqr"};
  EXPECT_EQ(jogged.crane().ask(crane_REQUEST_DISARM), "");
  EXPECT_NE(jogged.begin({true, false, false}), "");
}

TEST(Jog, NeedsAnAxis) {
  Jogged jogged{"lqr"};
  EXPECT_NE(jogged.begin({false, false, false}), "");
}

TEST(Jog, StopsByItselfWhenTheOperatorDies) {
  Jogged jogged{"time_optimal"};
  ASSERT_EQ(jogged.begin({true, false, false}), "");
  jogged.deflect({1, 0, 0}, 1.5);
  jogged.die();
  jogged.crane().run(0.12);
  EXPECT_EQ(jogged.crane().status().jog_deflection[0], 0) << "silence of 0.1 s is a release";
  jogged.crane().run_until_hold(10);
  EXPECT_EQ(jogged.crane().status().state, crane_STATE_HOLD);
}

TEST(Jog, StaysReleasedWhenASilentOperatorContinues) {
  Jogged jogged{"time_optimal"};
  ASSERT_EQ(jogged.begin({true, false, false}), "");
  jogged.deflect({1, 0, 0}, 1);
  jogged.die();
  jogged.crane().run(0.15);
  jogged.deflect({1, 0, 0}, 0.5);
  EXPECT_EQ(jogged.crane().status().jog_deflection[0], 0);
  EXPECT_EQ(jogged.events("jog_unusable"), 1);
  jogged.deflect({0, 0, 0}, 0.02);
  jogged.deflect({1, 0, 0}, 0.02);
  EXPECT_EQ(jogged.crane().status().jog_deflection[0], 1) << "the stick was released in between";
}

TEST(Jog, EndsWhenNoSampleFollowsTheRequest) {
  Jogged jogged{"time_optimal"};
  ASSERT_EQ(jogged.begin({true, false, false}), "");
  EXPECT_EQ(jogged.crane().status().state, crane_STATE_RUN);
  jogged.crane().run(1.2);
  EXPECT_EQ(jogged.crane().status().state, crane_STATE_HOLD);
}

/// The crane of these tests must not move.
class Stranger : public testing::Test {
 protected:
  Stranger() { from_m_ = jogged_.crane().state().trolley_position_m; }
  void expect_no_motion() { EXPECT_NEAR(jogged_.crane().state().trolley_position_m, from_m_, 2e-3); }
  Jogged jogged_{"time_optimal"};
  bus::Bus stranger_ = jogged_.crane().stranger();
  bus::Publisher<msg::Jog> forged_ = stranger_.publisher(topics::jog);
  double from_m_ = 0;
};

TEST_F(Stranger, WithoutARequestHasNoEffectAndIsReportedOnce) {
  jogged_.mischief = [this] { (void)forged_.publish(jogged_.sample({1, 1, 1})); };
  jogged_.crane().run(1);
  expect_no_motion();
  EXPECT_EQ(jogged_.crane().status().state, crane_STATE_HOLD);
  EXPECT_EQ(jogged_.events("jog_stranger"), 1);
}

TEST_F(Stranger, WhoCopiesClientAndIdHasNoEffectOnTheSession) {
  ASSERT_EQ(jogged_.begin({true, true, false}), "");
  jogged_.deflect({0, 0, 0}, 0.1);
  jogged_.mischief = [this] { (void)forged_.publish(jogged_.sample({1, 1, 1})); };
  jogged_.deflect({0, 0, 0}, 1);
  expect_no_motion();
  EXPECT_EQ(jogged_.crane().status().state, crane_STATE_RUN);
  EXPECT_EQ(jogged_.events("jog_stranger"), 1);
}

TEST_F(Stranger, WithTheFirstSampleDoesNotTakeTheSession) {
  ASSERT_EQ(jogged_.begin({true, true, false}), "");
  jogged_.mischief = [this] { (void)forged_.publish(jogged_.sample({1, 1, 1})); };
  jogged_.crane().run(0.3);
  expect_no_motion();
  jogged_.deflect({0.5, 0, 0}, 0.1);
  EXPECT_EQ(jogged_.crane().status().jog_deflection[0], 0.5);
}

TEST_F(Stranger, WhoFloodsTheTopicMovesNothing) {
  ASSERT_EQ(jogged_.begin({true, true, false}), "");
  jogged_.deflect({0, 0, 0}, 0.1);
  jogged_.mischief = [this] {
    for (int i = 0; i < 1000; ++i) (void)forged_.publish(jogged_.sample({1, 1, 1}));
  };
  jogged_.deflect({0, 0, 0}, 0.5);
  expect_no_motion();
  EXPECT_GE(jogged_.crane().status().state, crane_STATE_HOLD);
  EXPECT_LE(jogged_.crane().status().state, crane_STATE_RUN) << jogged_.crane().cause();
}

TEST(Jog, ADeflectionThatIsNotFiniteReleasesTheStick) {
  Jogged jogged{"time_optimal"};
  ASSERT_EQ(jogged.begin({true, false, false}), "");
  jogged.deflect({1, 0, 0}, 1);
  jogged.deflect({std::numeric_limits<double>::quiet_NaN(), 0, 0}, 0.05);
  EXPECT_EQ(jogged.crane().status().jog_deflection[0], 0);
  EXPECT_EQ(jogged.events("jog_unusable"), 1);
  jogged.crane().run_until_hold(10);
  EXPECT_EQ(jogged.crane().status().state, crane_STATE_HOLD);
}

TEST(Jog, AMoveReplacesTheSession) {
  Jogged jogged{"time_optimal"};
  ASSERT_EQ(jogged.begin({true, false, false}), "");
  jogged.deflect({0.3, 0, 0}, 1);
  msg::Request move{};
  move.kind = crane_REQUEST_MOVE;
  move.selected[0] = true;
  move.target[0] = 0.8;
  ASSERT_EQ(jogged.crane().ask(move), "");
  jogged.crane().run(8);
  EXPECT_EQ(jogged.crane().status().jog_deflection[0], 0);
  EXPECT_NEAR(jogged.crane().state().trolley_position_m, 0.8, 0.02);
}

/// A session that begins during a move at full speed.
class JogDuringAMove : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] static msg::Request move(double trolley_m, double slew_rad) {
    msg::Request request{};
    request.kind = crane_REQUEST_MOVE;
    request.selected[0] = request.selected[1] = true;
    request.target[0] = trolley_m;
    request.target[1] = slew_rad;
    return request;
  }
};

TEST_P(JogDuringAMove, FirstBringsTheCraneToRestOnThePathOfTheMove) {
  const auto rig = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
  Jogged jogged{GetParam()};
  auto& crane = jogged.crane();
  double lowest_m = 0;
  jogged.mischief = [&] { lowest_m = std::min(lowest_m, crane.state().trolley_position_m); };
  const auto begin_move = [&] {
    ASSERT_EQ(crane.ask(move(1.25, -0.8)), "");
    crane.run_until_hold(20);
    crane.run(5);
    ASSERT_EQ(crane.ask(move(0.22, 0.85)), "");
    lowest_m = crane.state().trolley_position_m;
  };
  begin_move();
  crane.run_until_hold(20);
  const double lowest_of_move_m = lowest_m;  // the law passes the target while it damps the swing
  int moving_sessions = 0;
  for (double begin_s = 0.25; begin_s < 3.6; begin_s += 0.35) {
    SCOPED_TRACE("the session begins " + std::to_string(begin_s) + " s after the move");
    begin_move();
    crane.run(begin_s);
    moving_sessions += std::abs(crane.state().trolley_speed_mps) > 0.2 ? 1 : 0;
    ASSERT_EQ(jogged.begin({false, true, false}), "");
    jogged.deflect({0, 0.02, 0}, 6);
    EXPECT_LT(std::abs(crane.state().trolley_speed_mps), 0.02);
    EXPECT_LT(std::abs(crane.state().slew_speed_radps), 0.02 * rig.drives[1].reference_speed + 0.03);
    jogged.release();
    EXPECT_GT(lowest_m, lowest_of_move_m - rig.drives[0].soft_margin / 2);
    ASSERT_EQ(crane.status().state, crane_STATE_HOLD) << crane.cause();
  }
  EXPECT_GE(moving_sessions, 2) << "sessions of this test must begin at speed";
}

INSTANTIATE_TEST_SUITE_P(With, JogDuringAMove,
                         testing::Values("time_optimal", "lqr", "delayed_1_optimised", "shaped_zv",
                                         "gain_scheduling_partial"),
                         [](const auto& test) { return std::string{test.param}; });

/// Rigs with other axes than the tower: without a slewing jib, without a hoist, without a load.
class JogOn : public testing::TestWithParam<const char*> {};

TEST_P(JogOn, MovesTheTrolleyWithTheStickAndEndsInHold) {
  Jogged jogged{"", GetParam()};
  const double from_m = jogged.crane().state().trolley_position_m;
  EXPECT_EQ(jogged.begin({true, false, false}), "");
  jogged.deflect({0.5, 0, 0}, 1);
  (void)jogged.release();
  // friction may hold the trolley of the drive_axis away from its reference: 20 s in RUN
  jogged.crane().run(2);
  EXPECT_EQ(jogged.crane().status().state, crane_STATE_HOLD);
  EXPECT_GT(jogged.crane().state().trolley_position_m, from_m + 0.05);
  EXPECT_EQ(jogged.crane().cause(), "NONE");
}

INSTANTIATE_TEST_SUITE_P(Rig, JogOn, testing::Values("gantry", "chapter_3_gantry", "drive_axis"),
                         [](const auto& test) { return std::string{test.param}; });

}  // namespace
}  // namespace crane::jog_test
