// Homing in the bridge, and the checks of LastLine for an axis without known position.
#include "crane/bridge/homing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "crane/bridge/measurement.hpp"
#include "last_line_timeline.hpp"

namespace crane::bridge::test {
namespace {

/// A trolley that the test moves while the bridge observes it.
class Hand {
 public:
  explicit Hand(const configuration::Rig& rig, double from_m = 0.5)
      : homing{rig}, drive_{rig.drives[0]}, encoder_{rig.encoders[0]}, true_m{from_m}, power_on_m_{from_m} {}

  Homing homing;
  bool requested = true, free = true;
  std::optional<std::int64_t> change;

 private:
  configuration::Drive drive_;
  configuration::Encoder encoder_;

 public:
  double true_m;

  /// Moves with this speed.
  void move(double speed_mps, double duration_s) {
    for (double passed_s = 0; passed_s < duration_s - 1e-9; passed_s += kPeriod_s) {
      true_m += speed_mps * kPeriod_s;
      tick();
    }
  }
  void tick() {
    const auto found = homing.step(
        0, {.counts = counts(), .active = active(), .requested = requested, .free = free, .rests = !free});
    if (found) change = found;
  }
  /// Homes the trolley: search at 0.05 m/s, back-off, approach, back-off.
  void run_course(double approach_mps = 0.01) {
    const double direction = drive_.homing.direction();
    const double to_mark_m = std::abs(true_m - drive_.homing.position);
    move(direction * 0.05, to_mark_m / 0.05 + 0.01);
    move(-direction * 0.05, 0.6);
    move(direction * approach_mps, 0.04 / approach_mps);
    move(-direction * 0.05, 1);
  }
  /// The brake closes; the supervisor requests homing until the position is known.
  void end() {
    free = false;
    tick();
    requested = false;
    tick();
  }
  [[nodiscard]] std::int64_t counts() const {
    return std::llround(encoder_.sign * (true_m - power_on_m_) * encoder_.counts_per_unit);
  }
  [[nodiscard]] bool active() const {
    return drive_.homing.mark == control::Mark::limit_high ? true_m >= drive_.homing.position
                                                           : true_m <= drive_.homing.position;
  }
  /// Position according to the counter.
  [[nodiscard]] double shown_m() const {
    return encoder_.sign * static_cast<double>(counts() + change.value_or(0)) / encoder_.counts_per_unit;
  }

 private:
  double power_on_m_;
};

TEST(Homing, OfATrolleyWithAnySignAndMarkPutsTheZeroWithinHalfATickOfTheApproach) {
  std::mt19937_64 random{7};
  for (int i = 0; i < 200; ++i) {
    auto rig = homing_tower();
    rig.encoders[0].sign = i % 2 == 0 ? 1 : -1;
    rig.drives[0].homing.mark = i % 3 == 0 ? control::Mark::limit_high : control::Mark::limit_low;
    rig.drives[0].homing.position = i % 3 == 0 ? 1.45 : 0.05;
    Hand hand{rig, std::uniform_real_distribution{0.2, 1.3}(random)};
    hand.run_course();
    EXPECT_TRUE(hand.homing.found(0)) << "seed 7, case " << i;
    EXPECT_FALSE(hand.homing.known(0)) << "not before the brake has closed";
    hand.end();
    ASSERT_TRUE(hand.homing.known(0)) << "seed 7, case " << i;
    const double half_a_tick_m = 0.01 * kPeriod_s / 2, count_m = 1 / rig.encoders[0].counts_per_unit;
    EXPECT_NEAR(hand.shown_m(), hand.true_m, half_a_tick_m + 2 * count_m) << "seed 7, case " << i;
  }
}

TEST(Homing, RequiresTwoDetectionsAtTheSamePositionTheSecondSlowly) {
  Hand once{homing_tower()};
  once.move(-0.05, 9.2);
  once.move(0.05, 1);
  once.end();
  EXPECT_FALSE(once.homing.known(0)) << "detected once";
  Hand fast{homing_tower()};
  fast.run_course(0.05);
  fast.end();
  EXPECT_FALSE(fast.homing.known(0)) << "approached at the speed of the search";
}

TEST(Homing, DoesNotCountABouncingContactAsTheSecondDetection) {
  Hand hand{homing_tower(), 0.0504};
  hand.move(-0.01, 0.06);
  for (int i = 0; i < 20; ++i) hand.move(i % 2 == 0 ? 0.02 : -0.02, 0.05);
  EXPECT_FALSE(hand.homing.found(0));
}

TEST(Homing, IgnoresASwitchWhileTheBrakeIsClosedOrNoAxisIsHomed) {
  for (const bool requested : {false, true}) {
    Hand hand{homing_tower()};
    hand.requested = requested;
    hand.free = !requested;
    hand.run_course();
    hand.end();
    EXPECT_FALSE(hand.homing.known(0));
  }
}

TEST(Homing, StaysUnknownWhenItIsInterrupted) {
  Hand hand{homing_tower()};
  hand.move(-0.05, 9.2);
  hand.move(0.05, 0.6);
  hand.end();
  hand.requested = hand.free = true;
  hand.move(-0.01, 4);  // first detection of a second homing
  hand.end();
  EXPECT_FALSE(hand.homing.known(0));
}

/// After the second detection, the supervisor may find a fault, or an operator may stop the crane. The
/// encoder may have lost counts since.
TEST(Homing, ThatEndsBeforeTheAxisRestsLeavesThePositionUnknown) {
  Hand hand{homing_tower()};
  hand.run_course();
  ASSERT_TRUE(hand.homing.found(0));
  hand.requested = hand.free = false;
  hand.tick();
  hand.tick();
  EXPECT_FALSE(hand.homing.known(0));
  EXPECT_FALSE(hand.homing.found(0));
}

TEST(Homing, OfAnAxisThatIsKnownForgetsItsZeroFirst) {
  Hand hand{homing_tower()};
  hand.run_course();
  hand.end();
  ASSERT_TRUE(hand.homing.known(0));
  hand.requested = true;
  hand.tick();
  EXPECT_FALSE(hand.homing.known(0));
}

TEST(Homing, AxesWithAssumedStartPositionsAreKnownFromTheStart) {
  const Homing homing{tower()};
  for (std::size_t i = 0; i < kDrives; ++i) EXPECT_TRUE(homing.known(i));
}

TEST(Coordinate, ChangesItsPositionByAShiftWithoutASpeed) {
  MeasurementPipeline measurement{homing_tower()};
  measurement.step({1000, 0, 0, 0, 0});
  measurement.shift(0, -400);
  const auto measured = measurement.step({1000, 0, 0, 0, 0});
  EXPECT_EQ(measurement.coordinates()[0].counts(), 600);
  EXPECT_DOUBLE_EQ(measured.position[0], 600 / homing_tower().encoders[0].counts_per_unit);
  EXPECT_EQ(measured.speed[0], 0);
}

class WithoutAZero : public testing::Test {
 protected:
  WithoutAZero() {
    timeline.unknown = timeline.homing = true;
    timeline.start_at(0.6);
    EXPECT_TRUE(timeline.tick(40)) << name_of(timeline.line.reason());
  }
  Timeline timeline{last_line_checks(), homing_tower()};
};

TEST_F(WithoutAZero, AnAxisMayCreepBeyondItsLimitsBecauseItsPositionIsUnknown) {
  timeline.speed_mps = 0.05;
  EXPECT_TRUE(timeline.tick(2000)) << name_of(timeline.line.reason());
  EXPECT_GT(timeline.trolley_m, homing_tower().drives[0].high_limit);
}

TEST_F(WithoutAZero, MoreThanCreepingVoltsAreRefused) {
  timeline.drive_v[0] = 5.1;
  EXPECT_FALSE(timeline.tick());
  EXPECT_EQ(timeline.line.reason(), Reason::not_homed);
  timeline.expect_safe();
}

TEST_F(WithoutAZero, MoreThanCreepingSpeedIsStoppedWithin50Ms) {
  timeline.speed_mps = 0.2;
  EXPECT_LE(timeline.ticks_until_stopped(), 5);
  EXPECT_EQ(timeline.line.reason(), Reason::not_homed);
}

TEST_F(WithoutAZero, ABrakeIsReleasedOnlyForHoming) {
  timeline.homing = false;
  EXPECT_FALSE(timeline.tick());
  EXPECT_EQ(timeline.line.reason(), Reason::not_homed);
}

TEST_F(WithoutAZero, ADeadEncoderIsDetectedAtVoltsThatBarelyMoveTheAxis) {
  timeline.encoder_dead = true;
  timeline.drive_v[0] = 2.5;
  EXPECT_LE(timeline.ticks_until_stopped(), 11);
  EXPECT_EQ(timeline.line.reason(), Reason::encoder_frozen);
}

TEST(MarkOfAHomedAxis, DetectedElsewhereMakesThePositionUnknownUntilHoming) {  // hazard 17
  Timeline timeline{last_line_checks(), homing_tower()};
  timeline.start_at(0.3);
  ASSERT_TRUE(timeline.tick(10));
  timeline.mark = true;  // the rig file has 0.05 m
  EXPECT_FALSE(timeline.tick());
  EXPECT_EQ(timeline.line.reason(), Reason::lost_counts);
  EXPECT_EQ(timeline.line.doubted(), (std::array<bool, kDrives>{true, false, false}));
  timeline.unknown = true;
  timeline.release = timeline.permission = false;
  timeline.tick();
  timeline.permission = true;
  EXPECT_TRUE(timeline.tick()) << "a counter that can be homed again needs no new start";
}

TEST(MarkOfAHomedAxis, DetectedAtItsPositionHasNoEffect) {
  Timeline timeline{last_line_checks(), homing_tower()};
  timeline.start_at(0.06);
  timeline.mark = true;
  EXPECT_TRUE(timeline.tick(5)) << name_of(timeline.line.reason());
}

TEST(MarkOfAHomedAxis, ANewOriginIsNotAMotion) {
  Timeline timeline{last_line_checks(), homing_tower()};
  timeline.release = false;
  timeline.start_at(0.3);
  ASSERT_TRUE(timeline.tick(40));
  ASSERT_TRUE(timeline.line.rests(0));
  timeline.line.shift(0, 0.5);
  timeline.trolley_m += 0.5;
  EXPECT_TRUE(timeline.tick(40)) << name_of(timeline.line.reason());
}

}  // namespace
}  // namespace crane::bridge::test
