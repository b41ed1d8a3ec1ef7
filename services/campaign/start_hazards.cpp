/// Hazards 28 to 30, 33, 34, 39, 40 and 42: start, homing and arming.
#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"
#include "stack/data_files.hpp"

namespace crane::campaign {
namespace {

/// Limits within which the axis cannot stop.
void bad_limits(Setting& setting, Random& random) {
  auto& drive = setting.configured.drives[setting.axis];
  switch (random.pick(4)) {
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

Injection never_armed(Bench& /*bench*/, Random& /*random*/) {
  return {.expectation = {.reasons = {because(crane_CAUSE_SELFTEST_FAILED)}, .detection_ms = 0},
          .watched_s = 0.2};
}

/// Power-on beyond a limit or with a swinging load.
void bad_start(Setting& setting, Random& random) {
  auto& start = setting.configured.start;
  if (random.pick(2) == 0)
    // the limit switch is also broken
    start.position[setting.axis] = setting.configured.drives[setting.axis].high_limit + 0.01;
  else
    start.swing_radial_rad = setting.configured.limits.swing_limit_rad * 1.3;
  setting.actual = setting.configured;
}

Injection reset_at_a_bad_start(Bench& bench, Random& /*random*/) {
  bench.rig().change_inputs = [](bridge::Inputs& inputs) { inputs.limit_high = inputs.limit_low = {}; };
  bench.run(2.5);
  bench.request(crane_REQUEST_RESET);
  return refusal();
}

Injection self_test_fails(Bench& bench, Random& random) {
  const bool brake = random.pick(2) == 0;
  bench.rig().change_inputs = [brake, i = bench.axis()](bridge::Inputs& inputs) {
    if (brake)
      inputs.brake_closed[i] = false;
    else
      inputs.watchdog_dropped = false;
  };
  bench.run(0.05);
  return {.expectation = {.reasons = {because(crane_CAUSE_SELFTEST_FAILED)}, .detection_ms = 2100},
          .watched_s = 2.5};
}

/// The operator's requests from LOCKED to READY.
void make_ready(Bench& bench) {
  emergency_stop(bench);
  bench.run(kClear_s);
  bench.request(crane_REQUEST_RESET);
  bench.run(kClear_s);
}

/// Arming that must not end in HOLD.
Injection arming_fails(Bench& bench, Random& random) {
  make_ready(bench);
  const std::size_t i = bench.axis();
  const auto kind = random.pick(3);
  Injection injection{.expectation = {.detection_ms = 5200}, .watched_s = 5.6};
  if (kind == 0) {
    bench.rig().change_inputs = [](bridge::Inputs& inputs) { inputs.watchdog_dropped = true; };
    injection.expectation.reasons = {because(crane_CAUSE_BRIDGE_LATCHED)};
  } else if (kind == 1) {
    bench.publish_fault = falsify(topics::demand, [i](msg::Demand& demand) { demand.total_v[i] = 3; });
    injection.expectation.reasons = {because(crane_CAUSE_DEMAND_RATE)};
  } else {
    auto moved = std::make_shared<double>(0);
    bench.rig().change_inputs = [moved, i, &bench](bridge::Inputs& inputs) {
      const auto& encoder = bench.setting().configured.encoders[i];
      const auto& drive = bench.setting().configured.drives[i];
      const auto& command = bench.now().command;
      if (command.brake_release[i])
        *moved += std::min(drive.max_speed * 0.8 * bench.setting().configured.period_s,
                           3 * drive.brake_slip - *moved);
      const auto by = std::llround(*moved * encoder.counts_per_unit * encoder.sign);
      inputs.raw_counts[i] = simulator::wrap_24_bit(inputs.raw_counts[i] + by);
    };
    injection.expectation.reasons = {because(crane_CAUSE_STOPPING_ENVELOPE)};
    // Detection time: ticks from the release of the brake until the axis has moved by `brake_slip`, plus two.
    const auto& drive = bench.setting().configured.drives[i];
    const double distance = 0.8 * drive.max_speed * bench.setting().configured.period_s;
    injection.expectation.detection_ms = 10 * std::ceil(drive.brake_slip / distance) + 20;
    injection.visible = [&bench, i] { return bench.now().command.brake_release[i]; };
  }
  bench.every_tick = [&bench, sent = false]() mutable {
    if (!sent) bench.send(crane_REQUEST_ARM);
    sent = true;
  };
  return injection;
}

void homing_rig(Setting& setting, Random& /*random*/) {
  setting.configured = configuration::load_rig(stack::find_rig("homing_servo_to_go"));
  setting.controller = control::find_controller(setting.configured.controller);
  setting.axis = 0;
  setting.selected = {true, false, false};
  setting.configured.start.position[0] = 0.16;  // a short distance to the mark
  setting.actual = setting.configured;
}

void request_homing(Bench& bench) {
  bench.run(kClear_s);
  bench.request(crane_REQUEST_RESET);
  bench.run(kClear_s);
  stack::OperatorRequest wanted{.kind = crane_REQUEST_HOME};
  wanted.selected[0] = true;
  bench.request(wanted);
  bench.run(0.4);
}

/// Detection time: 0.11 m to the mark and twice 0.02 m back at 0.05 m/s; at most 0.04 m of approach and
/// 0.02 m off the mark at 0.01 m/s; times 1.5 for starts and stops.
Injection homing(Bench& bench, Random& random) {
  request_homing(bench);
  Injection injection{.expectation = {.detection_ms = 14'000, .position_is_wrong = true}, .watched_s = 16};
  switch (random.pick(4)) {
    case 0:
      injection.expectation.reasons = {because(crane_CAUSE_HOMED)};
      break;
    case 1:  // the switch of the mark is stuck
      bench.rig().change_inputs = [](bridge::Inputs& inputs) { inputs.limit_low[0] = true; };
      injection.expectation.reasons = {because(crane_CAUSE_HOMING_FAILED)};
      break;
    case 2:  // a supervisor that treats the axis as homed
      bench.publish_fault = falsify(topics::command, [](msg::Command& command) {
        command.homing[0] = false;
        command.brake_release[0] = command.watchdog_permission = true;
        command.drive_v[0] = 4;
      });
      injection.expectation.reasons = {latched(crane_LATCH_NOT_HOMED)};
      injection.expectation.detection_ms = 10;
      injection.watched_s = 0.5;
      break;
    default:  // another axis loses its position while one axis is being homed
      bench.publish_fault = falsify(topics::state, [](msg::State& state) {
        for (bool& known : state.position_known) known = false;
      });
      bench.request(crane_REQUEST_ESTOP);
      bench.run(kClear_s);
      bench.request(crane_REQUEST_RESET);
      bench.run(kClear_s);
      bench.request(crane_REQUEST_ARM);
      return refusal();
  }
  return injection;
}

Injection zero_lost(Bench& bench, Random& /*random*/) {
  bench.publish_fault =
      falsify(topics::state, [i = bench.axis()](msg::State& state) { state.position_known[i] = false; });
  return {.expectation = {.reasons = {because(crane_CAUSE_NOT_HOMED)}, .detection_ms = 10}};
}

constexpr const char* kRecorder = "tests/recording, tests/cli: the recorder is a process outside the loop";

constexpr std::array kStartHazards{
    Hazard{.number = 28, .name = "bad configuration", .prepare = bad_limits, .inject = never_armed},
    Hazard{.number = 29,
           .name = "disk full while recording",
           .test_bed = TestBed::process,
           .verified_by = kRecorder},
    Hazard{.number = 30,
           .name = "power cut while recording",
           .test_bed = TestBed::process,
           .verified_by = kRecorder},
    Hazard{.number = 33,
           .name = "power-on outside the limits",
           .from_power_on = true,
           .prepare = bad_start,
           .inject = reset_at_a_bad_start},
    Hazard{.number = 34, .name = "self-test fails", .from_power_on = true, .inject = self_test_fails},
    Hazard{.number = 39,
           .name = "homing fails, position lost",
           .every = 3,
           .from_power_on = true,
           .prepare = homing_rig,
           .inject = homing},
    Hazard{.number = 40, .name = "arming fails", .every = 2, .inject = arming_fails},
    Hazard{.number = 42, .name = "position lost while armed", .inject = zero_lost},
};

}  // namespace

std::span<const Hazard> start_hazards() { return kStartHazards; }

}  // namespace crane::campaign
