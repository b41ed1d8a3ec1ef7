#include "trajectory_planner/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crane::services {
namespace {

using control::kHoist;
using control::kSlew;
using control::kTrolley;
using control::Shaping;

configuration::Rig tower() {
  return configuration::load_rig(std::string(CRANE_RIGS) + "/virginia_tech_tower.toml");
}

control::Measurement at_rest() {
  control::Measurement measured;
  measured.position = {0.3, 0, 1};
  return measured;
}

constexpr MoveTarget kTrolleyAndSlew{.selected = {true, true, false}, .target = {1.05, 1.5, 0}};
constexpr MoveTarget kTrolleyAndHoist{.selected = {true, false, true}, .target = {1.05, 0, 0.8}};

/// Ticks from the start of the move until trolley and slew references stay at their target.
std::uint64_t ticks_until_there(const Motion& motion, const MoveTarget& move) {
  std::uint64_t there = 0;
  for (std::uint64_t tick = 1; tick < 3000; ++tick)
    for (const auto axis : {kTrolley, kSlew})
      if (move.selected[axis] && std::abs(motion.at(tick)[axis].position - move.target[axis]) > 1e-12)
        there = tick + 1;
  return there;
}

Motion started(const configuration::Rig& rig, control::ReferenceShape shape, const MoveTarget& move) {
  Motion motion(rig, shape);
  motion.follow(at_rest(), 0);
  motion.start(move, 0);
  return motion;
}

/// Largest change of the trolley's acceleration in one tick, per second.
double largest_jerk(const Motion& motion, const configuration::Rig& rig) {
  double largest = 0;
  for (std::uint64_t tick = 1; tick < 1000; ++tick)
    largest = std::max(largest, std::abs(motion.at(tick + 1)[kTrolley].acceleration -
                                         motion.at(tick)[kTrolley].acceleration) /
                                    rig.period_s);
  return largest;
}

TEST(Motion, LimitsTheJerkWhenTheRigFileRequiresIt) {
  auto rig = tower();
  const auto shape = control::ReferenceShape::bang_coast_bang;
  EXPECT_GT(largest_jerk(started(rig, shape, kTrolleyAndSlew), rig), 2 * rig.drives[kTrolley].reference_jerk);
  rig.planning.limits_jerk = true;
  EXPECT_LE(largest_jerk(started(rig, shape, kTrolleyAndSlew), rig),
            rig.drives[kTrolley].reference_jerk * (1 + 1e-9));
}

TEST(Motion, ShapesTrolleyAndSlewByThePeriodOfTheLoad) {
  auto rig = tower();
  const auto shape = control::ReferenceShape::bang_coast_bang;
  const double period_ticks = 2 * std::numbers::pi * std::sqrt(1 / 9.81) / rig.period_s;
  const auto plain =
      static_cast<double>(ticks_until_there(started(rig, shape, kTrolleyAndSlew), kTrolleyAndSlew));
  for (const auto& [shaping, periods] : {std::pair{Shaping::zv, 0.5}, {Shaping::zvd, 1}, {Shaping::ei, 1}}) {
    rig.planning.shaping = shaping;
    const auto shaped =
        static_cast<double>(ticks_until_there(started(rig, shape, kTrolleyAndSlew), kTrolleyAndSlew));
    EXPECT_NEAR(shaped - plain, periods * period_ticks, 1);
  }
}

TEST(Motion, TakesTheMeanCableLengthAndLeavesTheHoistUnshaped) {
  auto rig = tower();
  const auto shape = control::ReferenceShape::bang_coast_bang;
  const auto plain = started(rig, shape, kTrolleyAndHoist);
  rig.planning.shaping = Shaping::zvd;
  const auto shaped = started(rig, shape, kTrolleyAndHoist);
  for (std::uint64_t tick = 0; tick < 1000; ++tick)
    EXPECT_EQ(plain.at(tick)[kHoist].position, shaped.at(tick)[kHoist].position);
  const double added = static_cast<double>(ticks_until_there(shaped, kTrolleyAndHoist)) -
                       static_cast<double>(ticks_until_there(plain, kTrolleyAndHoist));
  EXPECT_NEAR(added, 2 * std::numbers::pi * std::sqrt(0.9 / 9.81) / rig.period_s, 1);
}

TEST(Motion, LeavesTheStepsOfGainSchedulingAlone) {
  auto rig = tower();
  rig.planning = {.limits_jerk = true, .shaping = Shaping::ei};
  const auto motion = started(rig, control::ReferenceShape::step, kTrolleyAndSlew);
  EXPECT_EQ(motion.at(0)[kTrolley].position, 1.05);
  EXPECT_EQ(motion.at(0)[kSlew].position, 1.5);
}

TEST(Motion, HasNotArrivedBeforeItsLastImpulse) {
  auto rig = tower();
  rig.planning.shaping = Shaping::zvd;
  const auto motion = started(rig, control::ReferenceShape::bang_coast_bang, kTrolleyAndSlew);
  const auto there = ticks_until_there(motion, kTrolleyAndSlew);
  control::Measurement measured = at_rest();
  measured.position = {1.05, 1.5, 1};
  EXPECT_FALSE(motion.arrived(measured, there - 2));
  EXPECT_TRUE(motion.arrived(measured, there + 1));
}

TEST(Motion, ResetsItsShaperWhenTheReferenceFollowsTheCrane) {
  auto rig = tower();
  rig.planning.shaping = Shaping::ei;
  auto motion = started(rig, control::ReferenceShape::bang_coast_bang, kTrolleyAndSlew);
  auto measured = at_rest();
  measured.position[kTrolley] = 0.7;
  motion.follow(measured, 100);
  EXPECT_EQ(motion.at(100)[kTrolley].position, 0.7);
  EXPECT_TRUE(motion.arrived(measured, 101));
}

}  // namespace
}  // namespace crane::services
