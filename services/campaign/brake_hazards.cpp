/// Hazards 24, 25 and 31: brakes, emergency stop and limit switches.
#include "campaign/evidence.hpp"
#include "campaign/hazards.hpp"
#include "campaign/judge/truth.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

/// The brake of the axis is worn out, or hangs.
void broken_brake(Setting& setting, Dice& dice) {
  auto& drive = setting.wired.drives[setting.axis];
  if (dice.pick(2) == 0)
    drive.brake_close_time_s = 5;
  else
    drive.brake_deceleration = 0.05;
}

/// Farther than twice its way to a stop and its slip since the brakes were told to close (docs/safety.md).
std::function<bool()> slips(Bench& bench, std::size_t i) {
  const auto& rig = bench.setting().told;
  const auto& drive = rig.drives[i];
  const auto& truth = bench.now().truth;
  constexpr double kBrakesTold_ticks = 2;  // until the first sample under closed brakes
  // The axis may gain what its brake takes away, until it is told.
  const double v = std::abs(truth.speed[i]) + drive.brake_deceleration * rig.period_s * kBrakesTold_ticks;
  const double way = 2 * way_to_a_stop(drive, v, supervisor_reaction_s(rig, i)) + drive.brake_slip +
                     v * rig.period_s * kBrakesTold_ticks;
  return [&bench, i, way, from = truth.position[i]] {
    return std::abs(bench.now().truth.position[i] - from) > way;
  };
}

/// Due for a brake that does not report closed: closing time, 100 ms, one tick (docs/safety.md), and one tick
/// each for the command and the sample. For a worn one that reports closed: 100 ms (hazard 24) after the axis
/// has gone too far.
Strike brake_stays_open(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const bool silent = dice.pick(2) == 0;
  const bool hangs = bench.setting().wired.drives[i].brake_close_time_s > 1;
  if (silent) bench.world().spoil_inputs = [i](bridge::Inputs& inputs) { inputs.brake_closed[i] = false; };
  bench.ask(crane_REQUEST_ESTOP);
  Strike strike{.expectation = {.reasons = {because(crane_CAUSE_BRAKE_DID_NOT_CLOSE),
                                            latched(crane_LATCH_BRAKED_MOTION)},
                                .detection_ms = 100,
                                .brakes_are_broken = true},
                .watched_s = 1.5};
  if (silent || hangs)
    strike.expectation.detection_ms =
        1000 * bench.setting().told.drives[i].brake_close_time_s + 100 + 10 + 20;
  else
    strike.visible = slips(bench, i);
  return strike;
}

void worn_brake(Setting& setting, Dice& /*dice*/) {
  setting.wired.drives[setting.axis].brake_deceleration = 0.05;
}

/// The axis slides on under its closed brake, and the bridge does not tell that it has latched. Due: 100 ms
/// (hazard 24) after the axis has gone too far.
Strike slides_untold(Bench& bench, Dice& /*dice*/) {
  constexpr double kBound_ms = 100;
  bench.mad = madness(topics::state, [](msg::State& state) {
    state.latch_reason = crane_LATCH_NONE;
    state.command_invalid = state.command_stale = state.watchdog_dropped = false;
  });
  bench.ask(crane_REQUEST_ESTOP);
  return {.expectation = {.reasons = {because(crane_CAUSE_BRAKE_DID_NOT_CLOSE)},
                          .detection_ms = kBound_ms,
                          .cause_too = crane_CAUSE_BRAKE_DID_NOT_CLOSE,
                          .too_ms = kBound_ms,
                          .brakes_are_broken = true},
          .watched_s = 1.5,
          .visible = slips(bench, bench.axis())};
}

/// Due where the brake reports it: its closing time and two ticks; while it opens, 0.2 s and two ticks. Where
/// it does not: as for a drive that does not move its axis (evidence.hpp).
Strike brake_closes(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  bench.world().spoil_outputs = [i](bridge::Outputs& outputs) { outputs.brake_release[i] = false; };
  const bool unseen = dice.pick(2) == 0;
  if (unseen) bench.world().spoil_inputs = [i](bridge::Inputs& inputs) { inputs.brake_closed[i] = false; };
  if (!unseen) {
    const bool opening = bench.now().status.state == crane_STATE_ARMING;
    const double close_ms = 1000 * bench.setting().told.drives[i].brake_close_time_s;
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

Strike inputs_pressed(Bench& bench, Dice& dice) {
  if (dice.pick(3) > 0) {
    const bool wired = dice.pick(2) == 0;
    if (wired) bench.world().board().press_estop(true);
    if (!wired) bench.world().spoil_inputs = [](bridge::Inputs& inputs) { inputs.estop_pressed = true; };
    return {.expectation = {.reasons = {because(crane_CAUSE_ESTOP_INPUT)}, .detection_ms = 10}};
  }
  return switch_elsewhere(bench, dice);
}

constexpr std::array kOfBrakes{
    Hazard{.number = 24, .name = "brake fails to close", .prepare = broken_brake, .strike = brake_stays_open},
    Hazard{.number = 25, .name = "brake fails to open", .strike = brake_closes},
    Hazard{.number = 45,
           .name = "worn brake, bridge that is silent",
           .prepare = worn_brake,
           .strike = slides_untold},
    Hazard{.number = 31, .name = "e-stop and limit switches", .strike = inputs_pressed},
};

}  // namespace

std::span<const Hazard> brake_hazards() { return kOfBrakes; }

}  // namespace crane::campaign
