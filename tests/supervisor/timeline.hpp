#pragma once
// A supervisor with a simple crane in virtual time. The test controls the crane and reads like a timeline.
#include <algorithm>
#include <cmath>
#include <deque>

#include "crane/supervisor/supervisor.hpp"

namespace crane::supervisor {

inline Limits test_limits() {
  Limits limits;
  limits.axis[0] = {.present = true,
                    .low_limit = 0.1,
                    .high_limit = 1.4,
                    .soft_margin = 0.2,
                    .max_speed = 1,
                    .brake_deceleration = 5};
  limits.axis[1] = {.present = true,
                    .low_limit = -4,
                    .high_limit = 4,
                    .soft_margin = 0.5,
                    .max_speed = 2.5,
                    .brake_deceleration = 10,
                    .standstill_speed = 0.01,
                    .brake_slip = 0.05};
  return limits;
}

inline constexpr std::size_t index_of(Request request) { return static_cast<std::size_t>(request); }

class Timeline {
 public:
  explicit Timeline(const Limits& chosen = test_limits()) : limits{chosen} {
    world.sample.position = {0.7, 0, 1};
  }

  // Values that a test may change at any time.
  Limits limits;
  TickInput world{.state_arrived = true, .demand_arrived = true, .self_test = SelfTest::passed};
  PerAxis speed{};          // unit/s, while the brake is open
  bool brakes_obey = true;  // false: the brakes ignore commands
  bool axes_slip = false;   // true: closed brakes do not hold
  bool relay_obeys = true;
  double bridge_clock_ahead_s = 0;  // offset of the bridge's clock, when it runs on another host
  double late_s = 0;                // delay of the sample of this tick

  TickMemory memory;
  TickOutput out;

  void tick() {
    for (std::size_t i = 0; i < kAxes; ++i) {
      if (!world.sample.brake_closed[i] || axes_slip) world.sample.position[i] += speed[i] * limits.period_s;
    }
    ++world.tick;
    world.now_s = static_cast<double>(++elapsed_) * limits.period_s;
    if (world.state_arrived) world.sample.time_s = world.now_s + bridge_clock_ahead_s + late_s;
    out = step(limits, world, memory);
    world.requests = {};
    world.bridge_restarted = false;
    obey(out);
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) tick();
  }
  void run(double seconds) { ticks(static_cast<int>(std::lround(seconds / limits.period_s))); }

  Answer ask(Request request) {
    world.requests[index_of(request)] = true;
    tick();
    return out.answers[index_of(request)];
  }
  Answer reset() { return ask(Request::reset); }
  Answer arm() { return ask(Request::arm); }
  Answer disarm() { return ask(Request::disarm); }
  Answer stop() { return ask(Request::stop); }
  Answer estop() { return ask(Request::estop); }
  Answer move() {
    const Answer answer = ask(Request::move);
    if (answer.accepted) world.reference_moving = true;
    return answer;
  }

  /// The next state comes from a new bridge, with the axes at these positions.
  void start_bridge(const PerAxis& position) {
    world.bridge_restarted = world.state_arrived = true;
    world.tick = 0;
    world.sample.position = position;
  }

  void to_locked() { run(1.5); }
  void to_ready() { to_locked(), reset(); }
  void to_hold() { to_ready(), run(0.1), arm(), run(0.5); }
  void to_run() { to_hold(), move(), tick(); }

  [[nodiscard]] State state() const { return out.state; }
  [[nodiscard]] Cause cause() const { return out.cause; }
  [[nodiscard]] bool released() const {
    return out.brake_release[0] || out.brake_release[1] || out.brake_release[2];
  }
  [[nodiscard]] bool powered() const { return out.drive_v != PerAxis{}; }
  [[nodiscard]] bool safe() const { return !released() && !powered(); }
  void demand(double volts) { world.demand_v = {volts, volts, 0}; }

 private:
  // Brakes and relay follow three ticks after the command: one tick of delay, then 20 ms to close or open.
  void obey(const TickOutput& command) {
    delayed_.push_back(command);
    if (delayed_.size() < 3) {
      world.sample.brake_closed = {true, true, true};
      return;
    }
    const TickOutput& due = delayed_.front();
    if (relay_obeys) world.sample.watchdog_dropped = !due.watchdog_permission;
    for (std::size_t i = 0; i < kAxes && brakes_obey; ++i) {
      world.sample.brake_closed[i] = !due.brake_release[i] || world.sample.watchdog_dropped;
    }
    delayed_.pop_front();
  }
  std::deque<TickOutput> delayed_;
  std::uint64_t elapsed_ = 0;
};

}  // namespace crane::supervisor
