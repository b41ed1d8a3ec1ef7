/// Hazards 24, 25, 31, 45 and 46: brakes, watchdog relay, emergency stop and limit switches.
#include "campaign/evidence.hpp"
#include "campaign/hazards.hpp"
#include "campaign/judge/truth.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

/// The brake of the axis is worn, or does not close.
void broken_brake(Setting& setting, Random& random) {
  auto& drive = setting.actual.drives[setting.axis];
  if (random.pick(2) == 0)
    drive.brake_close_time_s = 5;
  else
    drive.brake_deceleration = 0.05;
}

/// True when the axis has moved by more than twice its stopping distance plus its slip since the command to
/// close (docs/safety.md).
std::function<bool()> slips(Bench& bench, std::size_t i) {
  const auto& rig = bench.setting().configured;
  const auto& drive = rig.drives[i];
  const auto& truth = bench.now().truth;
  constexpr double kBrakeCommand_ticks = 2;  // until the first sample with closed brakes
  // Until the command arrives, the axis may accelerate by at most the deceleration of the brake.
  const double v = std::abs(truth.speed[i]) + drive.brake_deceleration * rig.period_s * kBrakeCommand_ticks;
  const double distance = 2 * stopping_distance(drive, v, supervisor_reaction_s(rig, i)) + drive.brake_slip +
                          v * rig.period_s * kBrakeCommand_ticks;
  return [&bench, i, distance, from = truth.position[i]] {
    return std::abs(bench.now().truth.position[i] - from) > distance;
  };
}

/// Detection time for a brake that does not report closed: closing time, 100 ms, one tick (docs/safety.md),
/// and one tick each for command and sample. For a worn brake that reports closed: 100 ms (hazard 24) after
/// slips().
Injection brake_stays_open(Bench& bench, Random& random) {
  const std::size_t i = bench.axis();
  const bool silent = random.pick(2) == 0;
  const bool hangs = bench.setting().actual.drives[i].brake_close_time_s > 1;
  if (silent) bench.rig().change_inputs = [i](bridge::Inputs& inputs) { inputs.brake_closed[i] = false; };
  bench.request(crane_REQUEST_ESTOP);
  Injection injection{.expectation = {.reasons = {because(crane_CAUSE_BRAKE_DID_NOT_CLOSE),
                                                  latched(crane_LATCH_BRAKED_MOTION)},
                                      .detection_ms = 100,
                                      .brakes_do_not_close = true},
                      .watched_s = 1.5};
  if (silent || hangs)
    injection.expectation.detection_ms =
        1000 * bench.setting().configured.drives[i].brake_close_time_s + 100 + 10 + 20;
  else
    injection.visible = slips(bench, i);
  return injection;
}

void worn_brake(Setting& setting, Random& /*random*/) {
  setting.actual.drives[setting.axis].brake_deceleration = 0.05;
}

/// The axis moves with its closed brake, and the bridge does not report its latch. Detection time: 100 ms
/// (hazard 24) after slips().
Injection slides_without_latch(Bench& bench, Random& /*random*/) {
  constexpr double kBound_ms = 100;
  bench.publish_fault = falsify(topics::state, [](msg::State& state) {
    state.latch_reason = crane_LATCH_NONE;
    state.command_invalid = state.command_stale = false;
  });
  bench.request(crane_REQUEST_ESTOP);
  return {.expectation = {.reasons = {because(crane_CAUSE_BRAKE_DID_NOT_CLOSE)},
                          .detection_ms = kBound_ms,
                          .supervisor_must_find = crane_CAUSE_BRAKE_DID_NOT_CLOSE,
                          .independent_ms = kBound_ms,
                          .brakes_do_not_close = true},
          .watched_s = 1.5,
          .visible = slips(bench, bench.axis())};
}

/// Detection time when the brake contact reports closed: closing time and two ticks; in ARMING 0.2 s and two
/// ticks. When the contact reports nothing: as for a drive that does not move its axis (evidence.hpp).
Injection brake_closes(Bench& bench, Random& random) {
  const std::size_t i = bench.axis();
  bench.rig().change_outputs = [i](bridge::Outputs& outputs) { outputs.brake_release[i] = false; };
  const bool unseen = random.pick(2) == 0;
  if (unseen) bench.rig().change_inputs = [i](bridge::Inputs& inputs) { inputs.brake_closed[i] = false; };
  if (!unseen) {
    const bool opening = bench.now().status.state == crane_STATE_ARMING;
    const double close_ms = 1000 * bench.setting().configured.drives[i].brake_close_time_s;
    return {
        .expectation = {.reasons = {because(crane_CAUSE_BRAKE_DID_NOT_OPEN),
                                    because(crane_CAUSE_FOLLOWING_ERROR), because(crane_CAUSE_SWING_SENSOR)},
                        .detection_ms = opening ? 220.0 : close_ms + 20}};
  }
  auto reasons = drive_reasons();
  reasons.push_back(because(crane_CAUSE_BRAKE_DID_NOT_CLOSE));
  return {.expectation = {.reasons = reasons, .may_ride_through = true, .detection_ms = 1e6},
          .watched_s = 1.5};
}

/// The contacts of the relay are welded: it stays closed without toggling. Detection time: relay_timeout_s,
/// 110 ms, and one tick each for command and sample.
Injection relay_stays_closed(Bench& bench, Random& /*random*/) {
  bench.rig().change_inputs = [](bridge::Inputs& inputs) { inputs.watchdog_dropped = false; };
  bench.request(crane_REQUEST_ESTOP);
  const double bound_ms = 1000 * bench.setting().configured.wiring.relay_timeout_s + 110 + 20;
  return {.expectation = {.reasons = {because(crane_CAUSE_RELAY_DID_NOT_OPEN)},
                          .detection_ms = bound_ms,
                          .supervisor_must_find = crane_CAUSE_RELAY_DID_NOT_OPEN,
                          .independent_ms = bound_ms},
          .watched_s = 1};
}

Injection inputs_pressed(Bench& bench, Random& random) {
  if (random.pick(3) > 0) {
    const bool by_wire = random.pick(2) == 0;
    if (by_wire) bench.rig().board().press_estop(true);
    if (!by_wire) bench.rig().change_inputs = [](bridge::Inputs& inputs) { inputs.estop_pressed = true; };
    return {.expectation = {.reasons = {because(crane_CAUSE_ESTOP_INPUT)}, .detection_ms = 10}};
  }
  return switch_at_wrong_position(bench, random);
}

constexpr std::array kBrakeHazards{
    Hazard{.number = 24, .name = "brake fails to close", .prepare = broken_brake, .inject = brake_stays_open},
    Hazard{.number = 25, .name = "brake fails to open", .inject = brake_closes},
    Hazard{.number = 46, .name = "watchdog relay fails to open", .inject = relay_stays_closed},
    Hazard{.number = 45,
           .name = "worn brake, silent bridge",
           .prepare = worn_brake,
           .inject = slides_without_latch},
    Hazard{.number = 31, .name = "e-stop and limit switches", .inject = inputs_pressed},
};

}  // namespace

std::span<const Hazard> brake_hazards() { return kBrakeHazards; }

}  // namespace crane::campaign
