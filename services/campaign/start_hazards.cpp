/// Hazards 28 to 30, 33, 34, 39, 40 and 42: start, homing and arming.
#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"
#include "stack/data_files.hpp"

namespace crane::campaign {
namespace {

/// A margin that the axis does not stop in.
void bad_limits(Setting& setting, Dice& dice) {
  auto& drive = setting.told.drives[setting.axis];
  switch (dice.pick(4)) {
    case 0:
      drive.soft_margin = 1e-3;
      break;
    case 1:
      drive.brake_close_time_s = 0.5;
      break;
    case 2:
      drive.low_limit = drive.high_limit;
      break;
    default:
      drive.brake_deceleration = 0;
  }
}

Strike never_armed(Bench& /*bench*/, Dice& /*dice*/) {
  return {.expectation = {.reasons = {because(crane_CAUSE_SELFTEST_FAILED)}, .detection_ms = 0},
          .watched_s = 0.2};
}

/// The crane is switched on where it must not be: beyond a limit, or with a swinging load.
void bad_start(Setting& setting, Dice& dice) {
  auto& start = setting.told.start;
  if (dice.pick(2) == 0)
    start.position[setting.axis] =
        setting.told.drives[setting.axis].high_limit + 0.01;  // and its switch is broken
  else
    start.swing_radial_rad = setting.told.limits.swing_limit_rad * 1.3;
  setting.wired = setting.told;
}

Strike reset_at_a_bad_start(Bench& bench, Dice& /*dice*/) {
  bench.world().spoil_inputs = [](bridge::Inputs& inputs) { inputs.limit_high = inputs.limit_low = {}; };
  bench.run(2.5);
  bench.ask(crane_REQUEST_RESET);
  return refusal();
}

Strike self_test_fails(Bench& bench, Dice& dice) {
  const bool brake = dice.pick(2) == 0;
  bench.world().spoil_inputs = [brake, i = bench.axis()](bridge::Inputs& inputs) {
    if (brake)
      inputs.brake_closed[i] = false;
    else
      inputs.watchdog_dropped = false;
  };
  bench.run(0.05);
  return {.expectation = {.reasons = {because(crane_CAUSE_SELFTEST_FAILED)}, .detection_ms = 2100},
          .watched_s = 2.5};
}

/// From LOCKED to READY, by the operator.
void make_ready(Bench& bench) {
  stop_at_once(bench);
  bench.run(kClear_s);
  bench.ask(crane_REQUEST_RESET);
  bench.run(kClear_s);
}

/// Arming that must not end in HOLD.
Strike arming_fails(Bench& bench, Dice& dice) {
  make_ready(bench);
  const std::size_t i = bench.axis();
  const auto kind = dice.pick(3);
  Strike strike{.expectation = {.detection_ms = 5200}, .watched_s = 5.6};
  if (kind == 0) {
    bench.world().spoil_inputs = [](bridge::Inputs& inputs) { inputs.watchdog_dropped = true; };
    strike.expectation.reasons = {because(crane_CAUSE_BRIDGE_LATCHED)};
  } else if (kind == 1) {
    bench.mad = madness(topics::demand, [i](msg::Demand& demand) { demand.total_v[i] = 3; });
    strike.expectation.reasons = {because(crane_CAUSE_DEMAND_RATE)};
  } else {
    auto moved = std::make_shared<double>(0);
    bench.world().spoil_inputs = [moved, i, &bench](bridge::Inputs& inputs) {
      const auto& encoder = bench.setting().told.encoders[i];
      const auto& drive = bench.setting().told.drives[i];
      const auto& command = bench.now().command;
      if (command.brake_release[i])
        *moved +=
            std::min(drive.max_speed * 0.8 * bench.setting().told.period_s, 3 * drive.brake_slip - *moved);
      const auto by = std::llround(*moved * encoder.counts_per_unit * encoder.sign);
      inputs.raw_counts[i] = simulator::wrap_24_bit(inputs.raw_counts[i] + by);
    };
    strike.expectation.reasons = {because(crane_CAUSE_STOPPING_ENVELOPE)};
    // Due: the ticks to `brake_slip` from the release on, and two more.
    const auto& drive = bench.setting().told.drives[i];
    const double way = 0.8 * drive.max_speed * bench.setting().told.period_s;
    strike.expectation.detection_ms = 10 * std::ceil(drive.brake_slip / way) + 20;
    strike.visible = [&bench, i] { return bench.now().command.brake_release[i]; };
  }
  bench.every_tick = [&bench, asked = false]() mutable {
    if (!asked) bench.send(crane_REQUEST_ARM);
    asked = true;
  };
  return strike;
}

void homing_rig(Setting& setting, Dice& /*dice*/) {
  setting.told = configuration::load_rig(stack::find_rig("homing_servo_to_go"));
  setting.controller = control::find_controller(setting.told.controller);
  setting.axis = 0;
  setting.selected = {true, false, false};
  setting.told.start.position[0] = 0.16;  // a short way to the mark
  setting.wired = setting.told;
}

void ask_to_home(Bench& bench) {
  bench.run(kClear_s);
  bench.ask(crane_REQUEST_RESET);
  bench.run(kClear_s);
  stack::Wish wish{.kind = crane_REQUEST_HOME};
  wish.selected[0] = true;
  bench.ask(wish);
  bench.run(0.4);
}

/// Due: 0.11 m to the mark at 0.05 m/s, twice 0.02 m back, 0.04 m at most of approach and 0.02 m of leaving
/// at 0.01 m/s, and half as much again for starting and stopping.
Strike homing(Bench& bench, Dice& dice) {
  ask_to_home(bench);
  Strike strike{.expectation = {.detection_ms = 14'000, .position_is_false = true}, .watched_s = 16};
  switch (dice.pick(4)) {
    case 0:
      strike.expectation.reasons = {because(crane_CAUSE_HOMED)};
      break;
    case 1:  // the mark's switch hangs
      bench.world().spoil_inputs = [](bridge::Inputs& inputs) { inputs.limit_low[0] = true; };
      strike.expectation.reasons = {because(crane_CAUSE_HOMING_FAILED)};
      break;
    case 2:  // a supervisor that takes the axis for homed
      bench.mad = madness(topics::command, [](msg::Command& command) {
        command.homing[0] = false;
        command.brake_release[0] = command.watchdog_permission = true;
        command.drive_v[0] = 4;
      });
      strike.expectation.reasons = {latched(crane_LATCH_NOT_HOMED)};
      strike.expectation.detection_ms = 10;
      strike.watched_s = 0.5;
      break;
    default:  // the axis that is homed creeps; the zero of another is lost
      bench.mad = madness(topics::state, [](msg::State& state) {
        for (bool& known : state.position_known) known = false;
      });
      bench.ask(crane_REQUEST_ESTOP);
      bench.run(kClear_s);
      bench.ask(crane_REQUEST_RESET);
      bench.run(kClear_s);
      bench.ask(crane_REQUEST_ARM);
      return refusal();
  }
  return strike;
}

Strike zero_lost(Bench& bench, Dice& /*dice*/) {
  bench.mad =
      madness(topics::state, [i = bench.axis()](msg::State& state) { state.position_known[i] = false; });
  return {.expectation = {.reasons = {because(crane_CAUSE_NOT_HOMED)}, .detection_ms = 10}};
}

constexpr const char* kRecorder = "the recorder is a process beside the loop: tests/recording, tests/cli";

constexpr std::array kOfStarts{
    Hazard{.number = 28, .name = "bad configuration", .prepare = bad_limits, .strike = never_armed},
    Hazard{
        .number = 29, .name = "disk full while recording", .place = Place::process, .elsewhere = kRecorder},
    Hazard{
        .number = 30, .name = "power cut while recording", .place = Place::process, .elsewhere = kRecorder},
    Hazard{.number = 33,
           .name = "switched on at a bad place",
           .from_power_on = true,
           .prepare = bad_start,
           .strike = reset_at_a_bad_start},
    Hazard{.number = 34, .name = "self-test fails", .from_power_on = true, .strike = self_test_fails},
    Hazard{.number = 39,
           .name = "homing, and zeros that are lost",
           .every = 3,
           .from_power_on = true,
           .prepare = homing_rig,
           .strike = homing},
    Hazard{.number = 40, .name = "arming that fails", .every = 2, .strike = arming_fails},
    Hazard{.number = 42, .name = "zero lost while armed", .strike = zero_lost},
};

}  // namespace

std::span<const Hazard> start_hazards() { return kOfStarts; }

}  // namespace crane::campaign
