// The checks that compare the crane with its model: tolerances, detections, and the rate of false alarms.
#include <gtest/gtest.h>

#include <random>

#include "crane/configuration/encoder_resolution.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/supervisor/component.hpp"
#include "crane/supervisor/following.hpp"
#include "crane/supervisor/pendulum.hpp"
#include "crane/supervisor/run_length.hpp"

namespace crane::supervisor {
namespace {

constexpr double kTick_s = 0.01;
constexpr double kRarely_ticks = 1e9;  // 116 days of an armed crane

Limits limits_of_rig(const std::string& name) {
  return limits_of(configuration::load_rig(std::string{CRANE_RIGS} + "/" + name + ".toml"));
}

TEST(AverageRunLength, IsThatOfASimulatedSum) {
  constexpr double kDrift = 0.25, kThreshold = 4;
  std::mt19937_64 random{1};
  std::normal_distribution<double> noise;
  double ticks = 0;
  constexpr int kAlarms = 400;
  for (int alarm = 0; alarm < kAlarms; ++alarm)
    for (double sum = 0; sum <= kThreshold; ++ticks) sum = std::max(0.0, sum + noise(random) - kDrift);
  EXPECT_NEAR(ticks / kAlarms, average_run_length(kDrift, 1, kThreshold), 0.15 * ticks / kAlarms);
}

/// Applies a white disturbance with the size of the offset tolerance.
TEST(AverageRunLength, OfEachModelCheckIsAbove1e9TicksOnEachRig) {
  for (const char* name : {"virginia_tech_tower", "gantry", "emulated_servo_to_go", "drive_axis"}) {
    const Limits limits = limits_of_rig(name);
    const auto& p = limits.machine.crane;
    const PerAxis gain{p.trolley_gain_mps2pv, p.slew_gain_radps2pv, p.hoist_gain_mpspv / p.hoist_lag_s};
    for (std::size_t i = 0; i < kAxes; ++i) {
      if (!limits.axis[i].present) continue;
      const double drift = gain[i] * kOffset_v * kTick_s;
      EXPECT_GT(average_run_length(drift, drift, kSpeedShare * limits.axis[i].max_speed), kRarely_ticks)
          << name << ", axis " << i;
    }
    const double drift = pendulum_drift(limits, kTick_s);
    EXPECT_GT(average_run_length(drift, drift, kPermittedSum_mps), kRarely_ticks) << name;
  }
}

/// A trolley without load whose drive outputs `given` volts for a command of `told` volts.
class Trolley : public testing::Test {
 protected:
  Trolley() { limits_.machine.crane.load_mass_kg = 0; }
  /// @return number of ticks until a following error; 0: none
  int drive(double told_v, double given_v, int ticks, double gain = 1, bool encoder_stands = false) {
    for (int tick = 1; tick <= ticks; ++tick) {
      time_s_ += tick_s_;
      position_ += speed_ * tick_s_ + acceleration(given_v, gain) * tick_s_ * tick_s_ / 2;
      speed_ += acceleration(given_v, gain) * tick_s_;
      if (!encoder_stands) shown_ = position_;
      const bool found = following_error(
          limits_, {.sampled_s = time_s_, .position = {shown_, 0, 1}, .applied_v = {told_v}, .free = {true}},
          memory_);
      if (found) return tick;
    }
    return 0;
  }
  double acceleration(double volts_v, double gain) const {
    const auto& friction =
        speed_ > 0 ? limits_.machine.friction_positive[0] : limits_.machine.friction_negative[0];
    const double most_v = friction.rest_v + friction.viscous_vs_per_unit * std::abs(speed_);
    const double side = speed_ != 0 ? std::copysign(1, speed_) : std::copysign(1, volts_v);
    const double net_v = volts_v - side * most_v;
    if (speed_ == 0 && std::abs(volts_v) <= most_v) return 0;
    return gain * limits_.machine.crane.trolley_gain_mps2pv * net_v;
  }

  Limits limits_ = limits_of_rig("virginia_tech_tower");
  FollowingMemory memory_;
  double tick_s_ = kTick_s, time_s_ = 1, position_ = 0.5, speed_ = 0, shown_ = 0.5;
};

TEST_F(Trolley, ThatObeysCausesNoFollowingErrorWithinTheToleranceOfItsGain) {
  for (const double gain : {0.8, 1.0, 1.25}) {
    memory_ = {};
    speed_ = 0, shown_ = position_ = 0.5;
    EXPECT_EQ(drive(0, 0, 20, gain), 0);
    EXPECT_EQ(drive(5, 5, 20, gain), 0) << gain;
    EXPECT_EQ(drive(3, 3, 50, gain), 0) << gain;
  }
}

/// After each pause of 25 ms, the next tick follows after 3 ms.
TEST_F(Trolley, ThatObeysCausesNoFollowingErrorWhileTheComputerPauses) {
  struct Tick {
    double duration_s, volts_v;
  };
  double acting_v = 0;
  ASSERT_EQ(drive(0, 0, 20), 0);
  for (int round = 0; round < 20; ++round)
    for (const Tick tick : {Tick{0.025, 8}, Tick{0.003, -8}, Tick{0.025, -8}, Tick{0.003, 8}}) {
      ASSERT_EQ(drive(tick.volts_v, acting_v, 1), 0) << "round " << round;
      tick_s_ = tick.duration_s;
      acting_v = tick.volts_v;
    }
}

TEST_F(Trolley, WithAStuckConverterIsDetectedBeforeItIsFast) {
  ASSERT_EQ(drive(0, 0, 20), 0);
  const int ticks = drive(0, 10, 50);
  ASSERT_GT(ticks, 0);
  EXPECT_LE(ticks, 4);
  EXPECT_LT(std::abs(speed_), 0.75);
}

TEST_F(Trolley, WithAWrongSignOfItsDriveIsDetectedWithinFiveTicks) {
  ASSERT_EQ(drive(0, 0, 20), 0);
  const int ticks = drive(5, -5, 50);
  EXPECT_GT(ticks, 0);
  EXPECT_LE(ticks, 5);
}

TEST_F(Trolley, WithAFrozenEncoderIsDetectedInTheNextTicks) {
  ASSERT_EQ(drive(0, 0, 20), 0);
  ASSERT_EQ(drive(5, 5, 20), 0);
  const int ticks = drive(5, 5, 50, 1, true);
  EXPECT_GT(ticks, 0);
  EXPECT_LE(ticks, 2);
}

/// A pendulum with a resting trolley, or with a trolley that moves sinusoidally.
class Load : public testing::Test {
 protected:
  /// @return number of ticks until the failure of its encoders is detected; 0: not detected
  template <class Show>
  int swing(int ticks, Show show) {
    const double omega2 = 9.81 / cable_m_;
    constexpr int kSteps = 100;
    for (int tick = 1; tick <= ticks; ++tick) {
      for (int step = 0; step < kSteps; ++step) {
        const double pivot_mps2 = -trolley_m_ * kTrolley_radps * kTrolley_radps *
                                  std::sin(kTrolley_radps * (time_s_ + step * tick_s_ / kSteps));
        rate_ += ((wind_mps2_ + pivot_mps2 * std::cos(angle_)) / cable_m_ - omega2 * std::sin(angle_)) *
                 tick_s_ / kSteps;
        angle_ += rate_ * tick_s_ / kSteps;
      }
      time_s_ += tick_s_;
      const double step_m = limits_.machine.resolution[0];
      const double trolley_m = 0.5 + trolley_m_ * std::sin(kTrolley_radps * time_s_);
      const double position_m = std::round(trolley_m / step_m) * step_m;
      const double count = limits_.machine.swing_resolution_rad[0];
      double shown = std::round(show(angle_) / count) * count;
      if (limits_.machine.swing_filtered) shown = control::step(limits_.machine.swing_filter, filter_, shown);
      if (lost_ticks_ > 0 && tick % 25 < lost_ticks_) continue;
      if (swing_sensor_failed(
              limits_, {.sampled_s = time_s_, .position = {position_m, 0, measured_m_}, .radial_rad = shown},
              memory_))
        return tick;
    }
    return 0;
  }
  static double as_it_is(double angle) { return angle; }

  /// Restarts with swing angles behind the low-pass filter of section 4.3.
  void filter_angle(double angle_rad) {
    configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
    rig.sensing.filter_swing_angle = true;
    limits_ = limits_of(rig);
    filter_ = control::settled(limits_.machine.swing_filter, angle_rad);
    memory_ = {};
    angle_ = angle_rad, rate_ = 0;
  }

  static constexpr double kTrolley_radps = 5;  // amplitude 0.1 m: 2.5 m/s2
  Limits limits_ = limits_of_rig("virginia_tech_tower");
  PendulumMemory memory_;
  control::FilterMemory filter_;
  double tick_s_ = kTick_s;
  int lost_ticks_ = 0;  ///< ticks without a sample, of every 25
  double time_s_ = 1, angle_ = 0.3, rate_ = 0, cable_m_ = 1, measured_m_ = 1, wind_mps2_ = 0, trolley_m_ = 0;
};

TEST_F(Load, ThatSwingsIsNotAFailure) { EXPECT_EQ(swing(6000, as_it_is), 0); }

TEST_F(Load, ThatSwingsWidelyIsNotAFailureAtAnyRateOrCableLength) {
  for (const double tick_s : {0.001, 0.01, 0.02})
    for (const double cable_m : {0.4, 1.5, 80.0}) {
      SCOPED_TRACE(std::to_string(tick_s) + " s, " + std::to_string(cable_m) + " m");
      limits_.period_s = tick_s_ = tick_s;
      cable_m_ = measured_m_ = cable_m;
      memory_ = {};
      angle_ = 0.69, rate_ = 0;
      EXPECT_EQ(swing(static_cast<int>(30 / tick_s), as_it_is), 0) << memory_.largest;
    }
}

TEST_F(Load, OnACableThatIsHalfOrOneAndAHalfTimesAsLongCausesNoFailure) {
  for (const double ratio : {0.5, 1.5}) {
    memory_ = {};
    cable_m_ = ratio, angle_ = 0.3, rate_ = 0;
    EXPECT_EQ(swing(3000, as_it_is), 0) << ratio;
  }
}

TEST_F(Load, WithAZeroThatIsOffBy20MradCausesNoFailure) {
  EXPECT_EQ(swing(3000, [](double angle) { return angle + 0.02; }), 0);
}

TEST_F(Load, InTheWindOfTheRigFileCausesNoFailureButAStrongerWindDoes) {
  limits_.clearance.wind_mps2 = 0.8;
  wind_mps2_ = 0.8;
  EXPECT_EQ(swing(6000, as_it_is), 0);
  memory_ = {};
  wind_mps2_ = 1.2;  // larger than the tolerances of wind and zero error together, 0.8 + 0.2
  angle_ = std::asin(wind_mps2_ / 9.81), rate_ = 0;
  EXPECT_GT(swing(6000, as_it_is), 0);
}

TEST_F(Load, ThatIsPushedIsNotAFailure) {
  ASSERT_EQ(swing(100, as_it_is), 0);
  rate_ += 0.5;
  EXPECT_EQ(swing(1000, as_it_is), 0);
  rate_ -= 0.6;
  EXPECT_EQ(swing(1000, as_it_is), 0);
}

TEST_F(Load, WithAFrozenEncoderIsDetectedAtAnyAngle) {
  for (int begin = 60; begin < 160; begin += 7) {
    memory_ = {};
    angle_ = 0.3, rate_ = 0;
    ASSERT_EQ(swing(begin, as_it_is), 0);
    const double stands = angle_;
    const int ticks = swing(100, [stands](double) { return stands; });
    EXPECT_GT(ticks, 0) << begin;
    EXPECT_LE(ticks, 30) << begin << ", at " << stands << " rad";
  }
}

/// The low-pass filter delays the angle by 45 ms. At 2.5 m/s2, the sum would then grow by 1.5 m/s per second.
TEST_F(Load, UnderAMovingTrolleyCausesNoFailureWithOrWithoutFilteredAngles) {
  trolley_m_ = 0.1;
  EXPECT_EQ(swing(3000, as_it_is), 0);
  filter_angle(0.1);
  EXPECT_EQ(swing(3000, as_it_is), 0);
}

TEST_F(Load, OnATrolleyWithTheCoarsestPermittedEncoderCausesNoFailure) {
  const configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
  limits_.machine.resolution[0] = 1 / configuration::least_counts_per_unit(rig.drives[0], rig.period_s);
  trolley_m_ = 0.1;
  for (const double angle_rad : {0.0, 0.1, 0.2}) {
    memory_ = {};
    angle_ = angle_rad, rate_ = 0;
    EXPECT_EQ(swing(3000, as_it_is), 0) << angle_rad;
  }
}

/// The bridge filters interpolated positions for the ticks that it skips.
TEST_F(Load, WithFilteredAnglesAndMissingSamplesCausesNoFailure) {
  for (lost_ticks_ = 1; lost_ticks_ <= 2; ++lost_ticks_) {
    trolley_m_ = 0.2;  // up to 1 m/s
    filter_angle(0.1);
    EXPECT_EQ(swing(3000, as_it_is), 0) << lost_ticks_;
  }
}

TEST_F(Load, WithAFrozenEncoderAndFilteredAnglesIsDetected) {
  for (int begin = 60; begin < 160; begin += 7) {
    filter_angle(0.3);
    ASSERT_EQ(swing(begin, as_it_is), 0);
    const double stands = angle_;
    const int ticks = swing(100, [stands](double) { return stands; });
    EXPECT_GT(ticks, 0) << begin;
    EXPECT_LE(ticks, 40) << begin << ", at " << stands << " rad";
  }
}

TEST_F(Load, WithANoisyEncoderIsDetected) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> noise{-0.08, 0.08};
  ASSERT_EQ(swing(100, as_it_is), 0);
  const int ticks = swing(100, [&](double angle) { return angle + noise(random); });
  EXPECT_GT(ticks, 0);
  EXPECT_LE(ticks, 20);
}

}  // namespace
}  // namespace crane::supervisor
