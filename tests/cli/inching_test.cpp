/// Targets of inching, and of the return to the stop point.
#include "cli/inching.hpp"

#include <gtest/gtest.h>

namespace crane::cli {
namespace {

constexpr std::array<double, 3> kPlace{0.8, -0.3, 1.0};

TEST(Inching, MovesOneAxisByTheStep) {
  const auto targets = inched(kPlace, {.axis = 0, .direction = -1}, 0.002);
  EXPECT_EQ(targets.selected, (std::array{true, false, false}));
  EXPECT_DOUBLE_EQ(targets.target[0], 0.798);
  EXPECT_DOUBLE_EQ(inched(kPlace, {.axis = 2, .direction = 1}, 0.002).target[2], 1.002);
}

TEST(Inching, SlewsByTheSameArcAtTheRadiusOfTheTrolley) {
  const auto targets = inched(kPlace, {.axis = 1, .direction = 1}, 0.002);
  EXPECT_EQ(targets.selected, (std::array{false, true, false}));
  EXPECT_DOUBLE_EQ((targets.target[1] - kPlace[1]) * kPlace[0], 0.002);
}

TEST(Inching, SlewsByAFiniteAngleOnTheAxisOfSlewing) {
  EXPECT_DOUBLE_EQ(arc_rad(0.002, 0), 0.02);
  EXPECT_DOUBLE_EQ(arc_rad(0.002, -0.5), 0.004) << "a gantry has negative positions";
}

TEST(Inching, ThereAndBackIsNoMotion) {
  auto place = kPlace;
  for (std::size_t axis = 0; axis < place.size(); ++axis)
    for (const int direction : {1, -1})
      place = inched(place, {.axis = axis, .direction = direction}, 0.01).target;
  for (std::size_t axis = 0; axis < place.size(); ++axis) EXPECT_NEAR(place[axis], kPlace[axis], 1e-15);
}

TEST(ReturnToTheStopPoint, MovesTheDrivenAxes) {
  const auto targets = back_to(kPlace, kPlace, {false, true, false});
  EXPECT_EQ(targets.selected, (std::array{false, true, false}));
  EXPECT_EQ(targets.target, kPlace);
}

TEST(ReturnToTheStopPoint, AlsoMovesTheTrolleyThatCompensatedTheSlewing) {
  const std::array<double, 3> now{kPlace[0] - 0.004, 0.4, kPlace[2]};
  EXPECT_EQ(back_to(kPlace, now, {false, true, false}).selected, (std::array{true, true, false}));
}

}  // namespace
}  // namespace crane::cli
