/// Events of a gamepad: the deflection of each stick, and the conditions under which the sticks act.
#include "cli/gamepad_law.hpp"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <limits>
#include <random>

#include "cli/inching.hpp"

namespace crane::cli {
namespace {

using Deflection = std::array<double, 3>;
constexpr std::array kAllSticks{true, true, true};
constexpr int kFar = 32767, kDown = 1, kUp = 0;

GamepadEvent stick(std::uint16_t code, int value) { return {EV_ABS, code, value}; }
GamepadEvent button(std::uint16_t code, int value) { return {EV_KEY, code, value}; }

/// A gamepad with 16-bit ranges. Its dead-man's button is held from 1 s on.
class HeldGamepad : public testing::Test {
 protected:
  HeldGamepad() { law_.take(button(BTN_TL, kDown), 1); }
  GamepadLaw law_{StickRanges{}, kAllSticks};
};

TEST_F(HeldGamepad, DeflectsTheAxisOfEachStick) {
  law_.take(stick(ABS_Y, -32768), 1);
  law_.take(stick(ABS_X, kFar), 1);
  law_.take(stick(ABS_RY, kFar), 1);
  EXPECT_TRUE(law_.engaged(1));
  EXPECT_EQ(law_.deflection(), (Deflection{1, 1, 1})) << "away: outwards, right: positive, towards: down";
}

TEST_F(HeldGamepad, HasADeadZoneWithoutAJumpAtItsEdge) {
  const auto slew_at = [this](int value) {
    law_.take(stick(ABS_X, value), 1);
    return law_.deflection()[1];
  };
  EXPECT_EQ(slew_at(4096 - 1), 0);
  EXPECT_EQ(slew_at(-4096), 0);
  EXPECT_GT(slew_at(4110), 0);
  EXPECT_LT(slew_at(4110), 0.001);
  EXPECT_NEAR(slew_at(18431), 0.5, 1e-4) << "half of the way from the dead zone to the end";
}

TEST_F(HeldGamepad, IsSlowInMicroSpeed) {
  law_.take(stick(ABS_X, kFar), 1);
  law_.take(button(BTN_TR, kDown), 1);
  EXPECT_DOUBLE_EQ(law_.deflection()[1], kMicroSpeed);
  law_.take(button(BTN_TR, kUp), 1);
  EXPECT_DOUBLE_EQ(law_.deflection()[1], 1);
}

TEST_F(HeldGamepad, ActsOnlyWhileTheDeadMansButtonIsHeld) {
  law_.take(stick(ABS_X, kFar), 1.1);
  ASSERT_TRUE(law_.engaged(1.1));
  law_.take(button(BTN_TL, kUp), 1.2);
  EXPECT_FALSE(law_.engaged(1.2));
}

TEST_F(HeldGamepad, ActsAgainOnlyAfterTheSticksWereInTheCentre) {
  law_.take(stick(ABS_X, kFar), 1.1);
  law_.take(button(BTN_TL, kUp), 1.2);
  law_.take(button(BTN_TL, kDown), 1.3);
  EXPECT_FALSE(law_.engaged(1.3));
  EXPECT_TRUE(law_.waits_for_centre());
  law_.take(stick(ABS_X, 100), 1.4);
  EXPECT_TRUE(law_.engaged(1.4));
  law_.take(stick(ABS_X, kFar), 1.5);
  EXPECT_TRUE(law_.engaged(1.5)) << "the centre is required once per press";
}

TEST_F(HeldGamepad, IsReleasedByASilenceUntilTheButtonIsPressedAgain) {
  constexpr double kLater_s = 1.1 + GamepadLaw::kSilence_s;
  law_.take(stick(ABS_X, kFar), 1.1);
  EXPECT_TRUE(law_.engaged(kLater_s));
  EXPECT_FALSE(law_.engaged(kLater_s + 0.01));
  law_.take(stick(ABS_X, 30000), kLater_s + 1);
  law_.take(stick(ABS_X, 0), kLater_s + 1);
  EXPECT_FALSE(law_.engaged(kLater_s + 1)) << "motion does not begin again by itself";
  law_.take(button(BTN_TL, kUp), kLater_s + 2);
  law_.take(button(BTN_TL, kDown), kLater_s + 2);
  EXPECT_TRUE(law_.engaged(kLater_s + 2));
}

/// Repetitions by the kernel, synchronisations, scan codes, axes without a use and reports without a change.
TEST_F(HeldGamepad, IsNotKeptByEventsThatTheOperatorDoesNotCause) {
  law_.take(stick(ABS_X, kFar), 1.1);
  for (double t_s = 1.2; t_s < 1.2 + GamepadLaw::kSilence_s; t_s += 0.1) {
    law_.take(button(BTN_TL, 2), t_s);
    law_.take({EV_SYN, SYN_REPORT, 0}, t_s);
    law_.take({EV_MSC, MSC_SCAN, 1}, t_s);
    law_.take(stick(ABS_Z, static_cast<int>(10 * t_s)), t_s);
    law_.take(stick(ABS_X, kFar), t_s);
  }
  EXPECT_FALSE(law_.engaged(1.2 + GamepadLaw::kSilence_s));
}

TEST_F(HeldGamepad, ReturnsOnlyWhileTheButtonIsHeldAndReleasesTheSticks) {
  law_.take(stick(ABS_X, kFar), 1.1);
  law_.take(button(BTN_SOUTH, kDown), 1.2);
  EXPECT_FALSE(law_.engaged(1.2)) << "the return begins at rest";
  EXPECT_TRUE(law_.take_return());
  EXPECT_FALSE(law_.take_return());
  law_.take(button(BTN_TL, kUp), 1.3);
  law_.take(button(BTN_SOUTH, kDown), 1.4);
  EXPECT_FALSE(law_.take_return());
}

TEST(Gamepad, WithAButtonHeldSinceBeforeTheStartIsReleased) {
  GamepadLaw law{StickRanges{}, kAllSticks};
  law.take(stick(ABS_X, kFar), 1);
  law.take(button(BTN_TL, 2), 1);
  EXPECT_FALSE(law.engaged(1)) << "2 is a repetition of the kernel, no press";
}

TEST(Gamepad, WithAStickThatDriftsBeyondItsDeadZoneNeverActs) {
  StickRanges ranges{};
  ranges[0].value = 8000;
  GamepadLaw law{ranges, kAllSticks};
  law.take(button(BTN_TL, kDown), 1);
  EXPECT_FALSE(law.engaged(1));
  EXPECT_TRUE(law.waits_for_centre());
}

TEST(Gamepad, IgnoresTheSticksOfOtherAxes) {
  GamepadLaw law{StickRanges{}, {true, false, false}};
  law.take(button(BTN_TL, kDown), 1);
  law.take(stick(ABS_X, kFar), 1);
  EXPECT_EQ(law.deflection(), (Deflection{}));
}

TEST(Gamepad, WithAnUnusableRangeIsNamed) {
  const auto problem = [](StickRange range, std::array<bool, 3> selected = kAllSticks) {
    StickRanges ranges{};
    ranges[2] = range;
    return problem_of(ranges, selected);
  };
  EXPECT_EQ(problem({}), "");
  EXPECT_EQ(problem({.present = false}), "it has no axis ABS_RY (hoist)");
  EXPECT_EQ(problem({.minimum = 0, .maximum = 0}),
            "its axis ABS_RY (hoist) has no range: minimum 0, maximum 0");
  EXPECT_NE(problem({.minimum = 5, .maximum = -5}), "");
  EXPECT_NE(problem({.minimum = 0, .maximum = 255, .flat = 128}), "");
  EXPECT_NE(problem({.flat = -1}), "");
  EXPECT_EQ(problem({.present = false}, {true, true, false}), "") << "the session does not use this axis";
}

TEST(Gamepad, UsesTheDeadZoneOfTheDriverWhenItIsLarger) {
  StickRanges ranges{};
  ranges[1] = {.minimum = 0, .maximum = 200, .flat = 50, .value = 150};
  EXPECT_EQ(GamepadLaw(ranges, kAllSticks).deflection()[1], 0);
  ranges[1].value = 175;
  EXPECT_DOUBLE_EQ(GamepadLaw(ranges, kAllSticks).deflection()[1], 0.5);
}

TEST(Gamepad, WithRandomEventsNeverExceedsAFullDeflectionAndEndsWithTheButton) {
  constexpr unsigned kSeed = 11;
  constexpr std::array<std::uint16_t, 6> kCodes{ABS_X, ABS_Y, ABS_RY, BTN_TL, BTN_TR, BTN_SOUTH};
  constexpr std::array kValues{std::numeric_limits<int>::min(), -32768, -1, 0, 1, 2, 32767,
                               std::numeric_limits<int>::max()};
  std::mt19937 random{kSeed};
  GamepadLaw law{StickRanges{}, kAllSticks};
  for (int i = 0; i < 100'000; ++i) {
    const auto code = kCodes[random() % kCodes.size()];
    law.take({static_cast<std::uint16_t>(code >= BTN_SOUTH ? EV_KEY : EV_ABS), code,
              kValues[random() % kValues.size()]},
             i * 0.01);
    for (const double share : law.deflection()) ASSERT_LE(std::abs(share), 1) << "seed " << kSeed;
  }
  law.take(button(BTN_TL, kUp), 1e3);
  EXPECT_FALSE(law.engaged(1e3));
}

}  // namespace
}  // namespace crane::cli
