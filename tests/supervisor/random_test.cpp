// Long random histories. The observer that judges them does not use the state machine.
#include <gtest/gtest.h>

#include <iostream>
#include <limits>
#include <random>

#include "timeline.hpp"

namespace crane::supervisor {
namespace {

using Random = std::mt19937_64;

bool chance(Random& random, double probability) { return std::bernoulli_distribution{probability}(random); }
double between(Random& random, double low, double high) {
  return std::uniform_real_distribution{low, high}(random);
}

constexpr double kOdd[] = {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity(),
                           1e300,
                           -1e300,
                           12.8,
                           1e-320};

// Probability per tick that a fault begins, and that a present fault ends.
struct Weather {
  double fault = 0;
  double recovery = 0.05;
};

void disturb(Random& random, const Weather& weather, Timeline& t) {
  Sample& s = t.world.sample;
  const auto flip = [&](bool& flag, bool healthy) {
    if (chance(random, flag == healthy ? weather.fault : weather.recovery)) flag = !flag;
  };
  flip(t.world.state_arrived, true);
  flip(t.world.demand_arrived, true);
  flip(t.world.second_writer, false);
  flip(s.estop_pressed, false);
  flip(s.command_stale, false);
  flip(s.limit_high[0], false);
  flip(t.brakes_obey, true);
  if (chance(random, weather.fault)) t.start_bridge({0.7, 0, 1});
  if (chance(random, weather.fault)) ++s.overruns;
  if (chance(random, weather.fault)) s.position[1] = between(random, -4.1, 4.1);
  if (chance(random, weather.fault)) s.swing_radial_rad = between(random, -1, 1);
  if (chance(random, weather.recovery)) s.swing_radial_rad = 0;
}

void act(Random& random, Timeline& t) {
  for (std::size_t i = 0; i < kRequests; ++i) {
    const bool stops =
        i != index_of(Request::reset) && i != index_of(Request::arm) && i != index_of(Request::move);
    t.world.requests[i] = chance(random, stops ? 0.002 : 0.05);
  }
  if (chance(random, 0.02)) t.world.reference_moving = !t.world.reference_moving;
  t.world.demand_v = {};
  const bool active = t.state() == State::hold || t.state() == State::run;
  for (double& v : t.world.demand_v) v = active ? between(random, -14, 14) : between(random, -1, 1);
  if (chance(random, 0.01)) t.world.demand_v[0] = kOdd[random() % std::size(kOdd)];
  if (chance(random, 0.05)) t.speed = {between(random, -0.3, 0.3), between(random, -0.5, 0.5), 0};
}

// Checks I5 and I7 from inputs and outputs.
class Observer {
 public:
  void check(const Limits& limits, const Requests& requests, const TickOutput& out) {
    const bool released = out.brake_release[0] || out.brake_release[1] || out.brake_release[2];
    if (!out.watchdog_permission)
      reset_ = armed_ = false;  // the relay is open: reset and arm are required again
    if (requests[index_of(Request::reset)] && out.answers[index_of(Request::reset)].accepted) reset_ = true;
    if (reset_ && requests[index_of(Request::arm)] && out.answers[index_of(Request::arm)].accepted)
      armed_ = true;
    ASSERT_TRUE(!released || armed_) << "I5: brakes open without reset and arm";
    for (std::size_t i = 0; i < kAxes; ++i) {
      const double v = out.drive_v[i];
      ASSERT_TRUE(std::isfinite(v));
      ASSERT_TRUE(v == 0 || out.brake_release[i]) << "I5: voltage against a closed brake";
      ASSERT_LE(std::abs(v), limits.axis[i].volt_limit_v) << "I7";
      const double step_v = limits.axis[i].volt_rate_limit_vps * limits.period_s;
      const bool falls = std::abs(v) <= std::abs(last_v_[i]) && v * last_v_[i] >= 0;  // a stop may be faster
      ASSERT_TRUE(falls || std::abs(v - last_v_[i]) <= step_v + 1e-9) << "I7: " << last_v_[i] << " -> " << v;
    }
    last_v_ = out.drive_v;
    motion_ += released ? 1 : 0;
  }
  [[nodiscard]] long released_ticks() const { return motion_; }

 private:
  bool reset_ = false, armed_ = false;
  PerAxis last_v_{};
  long motion_ = 0;
};

class RandomHistory : public ::testing::TestWithParam<double> {};

TEST_P(RandomHistory, NeverMovesWithoutResetAndArmNorBeyondTheVoltLimits) {  // S17
  constexpr int kHistories = 60;
  constexpr int kTicks = 5000;
  long released = 0;
  for (unsigned seed = 1; seed <= kHistories; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random{seed};
    Timeline t;
    t.limits.axis[0].volt_rate_limit_vps = 400;
    t.limits.clear_time_s = t.limits.fresh_time_s = t.limits.longest_wait_for_motion_s = 0.2;
    Observer observer;
    for (int i = 0; i < kTicks; ++i) {
      disturb(random, {.fault = GetParam()}, t);
      act(random, t);
      const Requests requests = t.world.requests;
      t.tick();
      ASSERT_NO_FATAL_FAILURE(observer.check(t.limits, requests, t.out)) << "tick " << i;
    }
    released += observer.released_ticks();
  }
  std::cout << "fault rate " << GetParam() << ": brakes open in " << released << " of " << kHistories * kTicks
            << " ticks, seeds 1.." << kHistories << "\n";
  EXPECT_GT(released, 0);  // otherwise nothing was tested
}
INSTANTIATE_TEST_SUITE_P(FaultRates, RandomHistory, ::testing::Values(1e-4, 1e-3, 1e-2));

TEST(RandomHistory, AfterAnyHistoryWithoutAFaultAHealthyCraneCanBeArmedAgain) {  // S18
  int tried = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random{seed};
    Timeline t;
    for (int i = 0; i < 1500; ++i) {
      disturb(random, {.fault = 5e-4}, t);
      act(random, t);
      t.tick();
    }
    if (t.state() == State::fault) continue;
    ++tried;
    const Sample healthy{.position = {0.7, 0, 1},
                         .brake_closed = t.world.sample.brake_closed,
                         .watchdog_dropped = t.world.sample.watchdog_dropped,
                         .overruns = t.world.sample.overruns};
    const PerAxis where = t.world.sample.position;
    t.world = {.now_s = t.world.now_s,
               .tick = t.world.tick,
               .state_arrived = true,
               .sample = healthy,
               .bridge_restarted = t.memory.restart.swing_zero_doubtful,
               .demand_arrived = true,
               .self_test = SelfTest::passed};
    t.world.sample.position = {std::clamp(where[0], 0.15, 1.35), std::clamp(where[1], -3.9, 3.9), where[2]};
    t.speed = {};
    t.brakes_obey = true;
    t.stop();
    t.run(10);
    if (t.state() == State::fault) continue;  // an axis was moved while its brake was closed
    t.world.confirmed = {true, true, true};
    const Answer reset = t.reset();
    ASSERT_TRUE(reset.accepted || t.state() == State::hold) << name_of(t.state()) << ": " << reset.reason;
    t.run(0.1);
    if (t.state() == State::locked) t.reset();  // the first reset led to the self-test of a new bridge
    const Answer arm = t.arm();
    ASSERT_TRUE(arm.accepted) << arm.reason;
    t.run(0.5);
    ASSERT_EQ(t.state(), State::hold) << name_of(t.cause());
  }
  std::cout << tried << " of 200 histories, seeds 1..200\n";
  EXPECT_GT(tried, 50);
}

TEST(RandomHistory, WithoutFaultsNothingTrips) {  // S18
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random{seed};
    Timeline t;
    t.to_hold();
    for (int i = 0; i < 5000; ++i) {
      if (i % 500 == 0) t.world.requests[index_of(Request::move)] = true;
      t.world.reference_moving = i % 500 < 250;
      // a bang-bang maneuver with noise: full reversals and saturation
      t.demand((i / 37 % 2 == 0 ? 12.8 : -12.8) + between(random, -1, 1));
      t.speed = {0.3 * std::sin(0.02 * i), 0.8 * std::sin(0.01 * i), 0};
      t.world.sample.swing_radial_rad = 0.5 * std::sin(0.03 * i);
      t.tick();
      ASSERT_TRUE(t.state() == State::hold || t.state() == State::run) << i << " " << name_of(t.cause());
    }
  }
}

}  // namespace
}  // namespace crane::supervisor
