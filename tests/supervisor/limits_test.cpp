#include "crane/supervisor/limits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "timeline.hpp"

namespace crane::supervisor {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

TEST(SupervisorLimits, AreValidInTheTests) { EXPECT_THAT(problems(test_limits()), IsEmpty()); }

TEST(SupervisorLimits, RequireAMarginOfTheStoppingDistanceAtFullSpeed) {  // S19
  Limits limits = test_limits();
  // by hand: 10 ms detection, 20 ms ramp and delay, 20 ms brake, then 1^2 / (2 * 5)
  const double needed = 1 * (0.01 + 0.02 + 0.02) + 0.1;
  EXPECT_NEAR(stopping_distance(limits, 0, -1), needed, 1e-12);
  limits.axis[0].soft_margin = needed - 1e-6;
  EXPECT_THAT(problems(limits), ElementsAre(HasSubstr("trolley.soft_margin")));
  limits.axis[0].soft_margin = needed + 1e-6;
  EXPECT_THAT(problems(limits), IsEmpty());
}

TEST(SupervisorLimits, BoundTheTimeFromALostDemandToClosedBrakes) {  // S5
  Limits limits = test_limits();
  EXPECT_NEAR(demand_loss_to_braked_s(limits), 0.07, 1e-12);
  limits.demand_stale_after_ticks = 7;
  EXPECT_THAT(problems(limits), ElementsAre(StartsWith("demand_loss_to_braked_s = 0.11")));
}

TEST(SupervisorLimits, ReportEveryProblemAtOnceWithNameValueAndRule) {
  Limits limits = test_limits();
  limits.axis[0].volt_limit_v = 12;
  limits.axis[1].max_speed = std::numeric_limits<double>::quiet_NaN();
  limits.axis[1].high_limit = -5;
  limits.c1_ramp_time_s = 0.5;
  EXPECT_THAT(problems(limits),
              ElementsAre("c1_ramp_time_s = 0.5: must be in [0, 0.02]",
                          "trolley.volt_limit_v = 12: must be in (0, 10]",
                          "slew.max_speed = nan: must be finite and > 0", HasSubstr("slew.high_limit = -5"),
                          HasSubstr("slew.soft_margin")));
}

TEST(SupervisorLimits, ReportABoundThatIsNoInteger) {
  Limits limits = test_limits();
  limits.clear_time_s = 0.5;
  limits.load_watch_s = 0.2;
  EXPECT_THAT(problems(limits), ElementsAre("load_watch_s = 0.2: must be finite and >= 0.5"));
}

TEST(SupervisorLimits, NeedAtLeastOneAxisAndIgnoreAbsentOnes) {
  EXPECT_THAT(problems(Limits{}), ElementsAre(HasSubstr("at least one axis must be present")));
  Limits limits = test_limits();
  limits.axis[2].max_speed = -1;
  EXPECT_THAT(problems(limits), IsEmpty());
}

TEST(SupervisorLimits, HaveAtMostTheZonesThatTheFilterWatches) {
  Limits limits = test_limits();
  limits.zones.resize(control::kMostZones);
  EXPECT_THAT(problems(limits), IsEmpty());
  limits.zones.emplace_back();
  EXPECT_THAT(problems(limits), ElementsAre("zones = 101: must be at most 100"));
}

TEST(SupervisorLimits, AllowTargetsInsideTheSoftLimitsOnly) {
  const AxisLimits trolley = test_limits().axis[0];
  EXPECT_TRUE(target_allowed(trolley, 0.31));
  EXPECT_TRUE(target_allowed(trolley, 1.19));
  EXPECT_FALSE(target_allowed(trolley, 0.29));
  EXPECT_FALSE(target_allowed(trolley, 1.21));
  EXPECT_FALSE(target_allowed(trolley, std::numeric_limits<double>::quiet_NaN()));
}

TEST(Envelope, TreatsNaNAsAViolation) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(check_envelope(test_limits(), {.position = {nan, 0, 0}}).position);
  EXPECT_TRUE(check_envelope(test_limits(), {.position = {0.7, 0, 0}, .speed = {nan, 0, 0}}).overspeed);
  EXPECT_TRUE(check_envelope(test_limits(), {.position = {0.7, 0, 0}, .swing_radial_rad = nan}).swing);
}

TEST(Envelope, LimitsTheSpeedToTheShareOfTheOperatingMode) {
  EnvelopeInput input{.position = {0.7, 0, 0}, .speed = {0.3, 0, 0}, .speed_share = 0.25};
  EXPECT_TRUE(check_envelope(test_limits(), input).overspeed);
  input.speed[0] = 0.24;
  EXPECT_FALSE(check_envelope(test_limits(), input).overspeed);
}

TEST(OperatingMode, StopsAnAxisThatIsFasterThanTheModePermits) {
  Timeline crane;
  crane.to_run();
  crane.speed[0] = 0.3;
  crane.run(0.1);
  EXPECT_EQ(crane.state(), State::run) << "0.3 m/s is below max_speed";
  crane.world.speed_share = 0.25;
  crane.tick();
  EXPECT_EQ(crane.state(), State::stop_c0);
  EXPECT_EQ(crane.cause(), Cause::overspeed);
}

TEST(Envelope, LooksAheadInTheDirectionOfMotionOnly) {
  const EnvelopeInput out{.position = {1.35, 0, 0}, .speed = {0.8, 0, 0}};
  const EnvelopeInput in{.position = {1.35, 0, 0}, .speed = {-0.8, 0, 0}};
  EXPECT_TRUE(check_envelope(test_limits(), out).stopping);
  EXPECT_TRUE(check_envelope(test_limits(), out).block_positive[0]);
  EXPECT_FALSE(check_envelope(test_limits(), out).block_negative[0]);
  EXPECT_FALSE(check_envelope(test_limits(), in).stopping);
}

// Independent derivation: simulates the stop that the envelope triggers in fine steps.
TEST(Envelope, StopsAnAxisInsideTheHardLimits) {  // S9
  const Limits limits = test_limits();
  for (double speed = 0.05; speed <= 1; speed += 0.05) {
    double x = 0.7;
    double since_sample_s = 0;
    double stop_s = -1;
    double v = speed;
    constexpr double kStep_s = 1e-4;
    // Every tick has a check; the brakes act after ramp and delay (20 ms) and closing time (20 ms).
    for (int i = 0; v > 0 && i < 300000; ++i, since_sample_s += kStep_s) {
      if (since_sample_s >= limits.period_s && stop_s < 0) {
        since_sample_s = 0;
        if (check_envelope(limits, {.position = {x, 0, 0}, .speed = {v, 0, 0}}).stopping) stop_s = 0;
      }
      if (stop_s >= 0) stop_s += kStep_s;
      if (stop_s > 0.04) v -= 5 * kStep_s;
      x += v * kStep_s;
    }
    EXPECT_LE(x, limits.axis[0].high_limit + 1e-3 * speed) << speed;
    EXPECT_GE(x, limits.axis[0].high_limit - 0.02) << "stops far too early at " << speed;
  }
}

}  // namespace
}  // namespace crane::supervisor
