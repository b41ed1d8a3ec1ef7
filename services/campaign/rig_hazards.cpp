/// Hazards 14 to 25 and 31: encoders, converters, drives, brakes, switches and the load.
#include <algorithm>
#include <cmath>

#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

constexpr double kSeen = 0.005;  // m, rad: an error of a position that any check may be asked to see
constexpr double kSeenSwing_rad = 0.1;
constexpr double kSeen_v = 3;  // V, of what a drive gets against what it was told

const runtime::Encoder& encoder(const Bench& bench, std::size_t counter) {
  return bench.setting().told.encoders[counter];
}

std::int32_t counts(const Bench& bench, std::size_t counter, double change) {
  return static_cast<std::int32_t>(
      std::llround(change * encoder(bench, counter).counts_per_unit * encoder(bench, counter).sign));
}

/// The counter that feels the motion of the axis most: radial for trolley and hoist, tangential for the jib.
std::size_t swing_counter(const Bench& bench) { return bench.axis() == 1 ? 4 : 3; }

double direction(const Bench& bench) {
  return bench.setting().target[bench.axis()] >= bench.setting().told.start.position[bench.axis()] ? 1 : -1;
}

/// The counter runs over its end within the move, where the move leads away from 0.
void fine_encoders(Setting& setting, Dice& dice) {
  constexpr double kHalfRange = 1 << 23;
  const std::size_t i = setting.axis;
  const double start = setting.told.start.position[i], target = setting.target[i];
  if (std::abs(target) <= std::abs(start) + 0.1) return;
  const double at = start + dice.between(0.3, 0.7) * (target - start);
  if (std::abs(at) <= std::abs(start)) return;
  setting.told.encoders[i].counts_per_unit = setting.wired.encoders[i].counts_per_unit =
      kHalfRange / std::abs(at);
}

Strike nothing_at_all(Bench& /*bench*/, Dice& /*dice*/) { return {.expectation = {}, .watched_s = 2}; }

void shift_counter(Bench& bench, std::size_t counter, std::int32_t by) {
  bench.world().spoil_inputs = [counter, by](bridge::Inputs& inputs) {
    inputs.raw_counts[counter] = simulator::wrap_24_bit(std::int64_t{inputs.raw_counts[counter]} + by);
  };
}

/// The whole speed that the jump makes of the axis' own is `ratio` of its largest.
void jump_to_speed(Bench& bench, double ratio) {
  const std::size_t i = bench.axis();
  const auto& told = bench.setting().told;
  const double v = bench.now().truth.speed[i];
  const double side = v != 0 ? std::copysign(1, v) : direction(bench);
  const double jump = (ratio * told.drives[i].max_speed - std::abs(v)) * told.period_s;
  shift_counter(bench, i, counts(bench, i, side * jump));
}

Strike encoder_jump(Bench& bench, Dice& dice) {
  std::vector<Reason> reasons{latched(crane_LATCH_ENCODER_JUMP)};
  switch (dice.pick(4)) {
    case 0:
      shift_counter(bench, swing_counter(bench),
                    counts(bench, swing_counter(bench), dice.sign() * dice.between(0.4, 1)));
      break;
    case 1:
      jump_to_speed(bench, dice.between(1.2, 1.9));
      reasons = {latched(crane_LATCH_SPEED), latched(crane_LATCH_POSITION)};
      break;
    case 2:
      jump_to_speed(bench, dice.between(1.03, 1.07));
      reasons = {because(crane_CAUSE_OVERSPEED), latched(crane_LATCH_POSITION)};
      break;
    default:
      jump_to_speed(bench, dice.between(2.3, 40));
  }
  return {.expectation = {.reasons = reasons, .detection_ms = 10}};
}

std::function<bool()> sees_error(Bench& bench, std::size_t counter, double error) {
  return [&bench, counter, error] { return bench.world().shown_error()[counter] > error; };
}

Strike encoder_frozen(Bench& bench, Dice& /*dice*/) {
  auto at = std::make_shared<std::optional<std::int32_t>>();
  const std::size_t i = bench.axis();
  bench.world().spoil_inputs = [at, i](bridge::Inputs& inputs) {
    if (!*at) *at = inputs.raw_counts[i];
    inputs.raw_counts[i] = **at;
  };
  return {
      .expectation = {.reasons = {latched(crane_LATCH_ENCODER_FROZEN), because(crane_CAUSE_FOLLOWING_ERROR)},
                      .detection_ms = 300},
      .watched_s = 2,
      .visible = sees_error(bench, i, kSeen)};
}

/// The counter misses a share of the way; nothing but a mark or a switch can tell.
Strike lost_counts(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const double kept = dice.between(0.85, 0.97);
  const auto first = static_cast<double>(bench.world().board().read().raw_counts[i]);
  bench.world().spoil_inputs = [i, kept, first](bridge::Inputs& inputs) {
    inputs.raw_counts[i] =
        static_cast<std::int32_t>(std::lround(first + kept * (inputs.raw_counts[i] - first)));
  };
  return {.expectation = {.reasons = {latched(crane_LATCH_LOST_COUNTS), because(crane_CAUSE_LIMIT_SWITCH),
                                      because(crane_CAUSE_FOLLOWING_ERROR)},
                          .may_ride_through = true,
                          .detection_ms = 1e6,
                          .position_is_false = true},
          .watched_s = 1.5};
}

/// A limit switch closes where the counter says there is none.
Strike switch_elsewhere(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const bool high = dice.pick(2) == 0;
  bench.world().spoil_inputs = [i, high](bridge::Inputs& inputs) {
    (high ? inputs.limit_high : inputs.limit_low)[i] = true;
  };
  const auto& drive = bench.setting().told.drives[i];
  const double x = bench.now().truth.position[i];
  const bool near =
      high ? x > drive.high_limit - 1.2 * drive.soft_margin : x < drive.low_limit + 1.2 * drive.soft_margin;
  std::vector<Reason> reasons{latched(crane_LATCH_LOST_COUNTS)};
  if (near) reasons.push_back(because(crane_CAUSE_LIMIT_SWITCH));
  return {.expectation = {.reasons = reasons, .detection_ms = 10}};
}

Strike counts_wrong(Bench& bench, Dice& dice) {
  return dice.pick(3) == 0 ? switch_elsewhere(bench, dice) : lost_counts(bench, dice);
}

Strike swing_encoder(Bench& bench, Dice& dice) {
  const std::size_t counter = swing_counter(bench);
  auto at = std::make_shared<std::optional<std::int32_t>>();
  auto noise = std::make_shared<Dice>(dice.pick(1U << 30U));
  const auto shake = static_cast<double>(counts(bench, counter, 0.08));
  const auto kind = dice.pick(4);
  bench.world().spoil_inputs = [=](bridge::Inputs& inputs) {
    auto& shown = inputs.raw_counts[counter];
    if (!*at) *at = shown;
    if (kind == 0) shown = **at;
    if (kind == 1) shown = 0;
    if (kind == 2) shown += static_cast<std::int32_t>(std::lround(noise->between(-shake, shake)));
    if (kind == 3) shown = -shown;
  };
  return {.expectation = {.reasons = {because(crane_CAUSE_SWING_SENSOR), latched(crane_LATCH_ENCODER_JUMP)},
                          .detection_ms = 800},
          .watched_s = 2,
          .visible = sees_error(bench, counter, kSeenSwing_rad)};
}

std::function<bool()> sees_volts(Bench& bench, std::size_t axis) {
  return [&bench, axis] {
    const auto& truth = bench.now().truth;
    return bench.world().output_error_v(axis) > kSeen_v && !truth.brake_closed[axis];
  };
}

std::vector<Reason> drive_reasons() {
  return {because(crane_CAUSE_FOLLOWING_ERROR), latched(crane_LATCH_DRIVE_RESPONSE),
          latched(crane_LATCH_ENCODER_FROZEN), because(crane_CAUSE_STOPPING_ENVELOPE)};
}

/// Stuck where it is, at the end of its range, or the wrong sign.
Strike converter(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const auto kind = dice.pick(3);
  const double stuck_v = kind == 0 ? bench.now().truth.converter_v[i] * bench.setting().told.drives[i].sign
                                   : dice.sign() * dice.between(6, 10);
  bench.world().spoil_outputs = [i, kind, stuck_v](bridge::Outputs& outputs) {
    outputs.drive_v[i] = kind == 2 ? -outputs.drive_v[i] : stuck_v;
  };
  return {.expectation = {.reasons = drive_reasons(),
                          .may_ride_through = true,
                          .detection_ms = 900,
                          .position_is_false = true},
          .watched_s = 1.5,
          .visible = sees_volts(bench, i)};
}

/// A drive that gives a part of what it is told, or that much more.
Strike weak_drive(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const auto kind = dice.pick(3);
  const double offset_v = dice.sign() * dice.between(3, 5);
  bench.world().spoil_outputs = [i, kind, offset_v](bridge::Outputs& outputs) {
    if (kind == 0) outputs.drive_v[i] = 0;
    if (kind == 1) outputs.drive_v[i] += offset_v;
    if (kind == 2) outputs.drive_v[i] *= 2;
  };
  return {.expectation = {.reasons = drive_reasons(),
                          .may_ride_through = kind == 2,
                          .detection_ms = 1e6,
                          .position_is_false = false},
          .watched_s = 2,
          .visible = sees_volts(bench, i)};
}

/// A controller that knows one voltage only.
Strike overspeed(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const double volts_v = direction(bench) * dice.between(7, 10);
  bench.mad = madness(topics::demand, [i, volts_v](msg::Demand& demand) { demand.total_v[i] = volts_v; });
  return {.expectation = {.reasons = {because(crane_CAUSE_OVERSPEED), because(crane_CAUSE_STOPPING_ENVELOPE),
                                      because(crane_CAUSE_SWING_LIMIT), because(crane_CAUSE_FOLLOWING_ERROR),
                                      because(crane_CAUSE_DEMAND_RATE)},
                          .may_ride_through = true,
                          .detection_ms = 6000},
          .watched_s = 3};
}

/// A supervisor that has forgotten everything: brakes open, one voltage for ever.
void mad_supervisor(Bench& bench, double volts_v, bool all_axes) {
  bench.mad = madness(topics::command,
                      [i = bench.axis(), volts_v, all_axes, before = 0.0](msg::Command& command) mutable {
                        before += std::clamp(volts_v - before, -2.0, 2.0);
                        for (std::size_t k = 0; k < kAxes; ++k) {
                          command.brake_release[k] = k == i || all_axes;
                          command.drive_v[k] = k == i ? before : 0;
                        }
                        command.watchdog_permission = true;
                      });
}

Strike position_limit(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  if (dice.pick(2) == 0) {
    const double volts_v = direction(bench) * dice.between(3, 5);
    bench.mad = madness(topics::demand, [i, volts_v](msg::Demand& demand) { demand.total_v[i] = volts_v; });
    return {
        .expectation = {.reasons = {because(crane_CAUSE_STOPPING_ENVELOPE), because(crane_CAUSE_SWING_LIMIT),
                                    because(crane_CAUSE_OVERSPEED), because(crane_CAUSE_FOLLOWING_ERROR)},
                        .may_ride_through = true,
                        .detection_ms = 8000,
                        .outwards_axis = i,
                        .outwards = direction(bench)},
        .watched_s = 4};
  }
  mad_supervisor(bench, direction(bench) * dice.between(3, 8), false);
  return {
      .expectation = {.reasons = {latched(crane_LATCH_POSITION), latched(crane_LATCH_SPEED),
                                  latched(crane_LATCH_SWING), latched(crane_LATCH_DRIVE_RESPONSE),
                                  because(crane_CAUSE_STOPPING_ENVELOPE), because(crane_CAUSE_SWING_LIMIT),
                                  because(crane_CAUSE_FOLLOWING_ERROR), because(crane_CAUSE_OVERSPEED)},
                      .may_ride_through = true,
                      .detection_ms = 8000},
      .watched_s = 4};
}

/// A push against the load that swings it so far. @param rad  amplitude
void push(Bench& bench, double rad) {
  const double cable_m = bench.now().truth.position[2];
  const double rate_radps = std::sqrt(2 * 9.81 / cable_m * (1 - std::cos(rad)));
  const bool radial = swing_counter(bench) == 3;
  bench.world().board().kick(radial ? rate_radps : 0, radial ? 0 : rate_radps);
}

/// The supervisor does nothing about it: the bridge has to.
Strike swing_of_a_mad_supervisor(Bench& bench, double limit_rad) {
  mad_supervisor(bench, 0, true);
  push(bench, 1.9 * limit_rad);
  return {.expectation = {.reasons = {because(crane_CAUSE_SWING_LIMIT), latched(crane_LATCH_SWING),
                                      because(crane_CAUSE_BRAKE_DID_NOT_CLOSE),
                                      because(crane_CAUSE_STOPPING_ENVELOPE)},
                          .detection_ms = 1e6,
                          .supervisor_gone = true,
                          .latch_too = crane_LATCH_SWING,
                          .latch_ms = 10},
          .watched_s = 1.5,
          .visible = [&bench, limit_rad] {
            const auto& truth = bench.now().truth;
            return std::max(std::abs(truth.swing_radial_rad), std::abs(truth.swing_tangential_rad)) >
                   1.51 * limit_rad;
          }};
}

Strike swing_limit(Bench& bench, Dice& dice) {
  const double limit_rad = bench.setting().told.limits.swing_limit_rad;
  if (dice.pick(4) == 0) return swing_of_a_mad_supervisor(bench, limit_rad);
  push(bench, limit_rad * dice.between(1.15, 1.7));
  return {.expectation = {.reasons = {because(crane_CAUSE_SWING_LIMIT), latched(crane_LATCH_SWING)},
                          .may_ride_through = true,
                          .detection_ms = 20},
          .watched_s = 2,
          .visible = [&bench, limit_rad] {
            const auto& truth = bench.now().truth;
            return std::max(std::abs(truth.swing_radial_rad), std::abs(truth.swing_tangential_rad)) >
                   limit_rad;
          }};
}

/// The brake of the axis is worn out, or hangs.
void broken_brake(Setting& setting, Dice& dice) {
  auto& drive = setting.wired.drives[setting.axis];
  if (dice.pick(2) == 0)
    drive.brake_close_time_s = 5;
  else
    drive.brake_deceleration = 0.05;
}

Strike brake_stays_open(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const bool silent = dice.pick(2) == 0;
  const auto& wired = bench.setting().wired.drives[i];
  const bool hangs = wired.brake_close_time_s > 1;
  if (silent) bench.world().spoil_inputs = [i](bridge::Inputs& inputs) { inputs.brake_closed[i] = false; };
  bench.ask(crane_REQUEST_ESTOP);
  const bool seen = silent || hangs;
  return {.expectation = {.reasons = {because(crane_CAUSE_BRAKE_DID_NOT_CLOSE),
                                      latched(crane_LATCH_BRAKED_MOTION)},
                          .may_ride_through = !seen,
                          .detection_ms = seen ? 150.0 : 1e6,
                          .brakes_are_broken = true},
          .watched_s = 1.5};
}

Strike brake_closes(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  bench.world().spoil_outputs = [i](bridge::Outputs& outputs) { outputs.brake_release[i] = false; };
  const bool unseen = dice.pick(2) == 0;
  if (unseen) bench.world().spoil_inputs = [i](bridge::Inputs& inputs) { inputs.brake_closed[i] = false; };
  if (!unseen) {
    const bool opening = bench.now().status.state == crane_STATE_ARMING;
    return {.expectation = {
                .reasons = {because(crane_CAUSE_BRAKE_DID_NOT_OPEN), because(crane_CAUSE_FOLLOWING_ERROR)},
                .detection_ms = opening ? 230.0 : 50.0}};
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

/// What the bridge has to find without the supervisor, which has gone mad and pushes for ever.
Strike needs_nobody(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const double side = direction(bench);
  const auto kind = dice.pick(3);
  Strike strike{.expectation = {.reasons = drive_reasons(),
                                .detection_ms = 1e6,
                                .position_is_false = true,
                                .supervisor_gone = true},
                .watched_s = 1.5};
  auto& wanted = strike.expectation;
  for (const auto cause : {crane_CAUSE_BRAKE_DID_NOT_CLOSE, crane_CAUSE_OVERSPEED,
                           crane_CAUSE_STOPPING_ENVELOPE, crane_CAUSE_SWING_LIMIT})
    wanted.reasons.push_back(because(cause));
  if (kind == 0) {  // an encoder stands, and the drive pushes
    mad_supervisor(bench, side * 8, true);
    auto at = std::make_shared<std::optional<std::int32_t>>();
    bench.world().spoil_inputs = [at, i](bridge::Inputs& inputs) {
      if (!*at) *at = inputs.raw_counts[i];
      inputs.raw_counts[i] = **at;
    };
    wanted.latch_too = crane_LATCH_ENCODER_FROZEN;
    wanted.latch_ms = 250;
  } else if (kind == 1 && i != 2) {  // the drive does the opposite of what it is told
    mad_supervisor(bench, -side * 5, true);
    bench.world().spoil_outputs = [i](bridge::Outputs& outputs) {
      outputs.drive_v[i] = -2 * outputs.drive_v[i];
    };
    wanted.latch_too = crane_LATCH_DRIVE_RESPONSE;
    wanted.latch_ms = 500;
  } else {  // the axis creeps under its closed brake
    bench.ask(crane_REQUEST_ESTOP);
    bench.run(0.5);
    auto moved = std::make_shared<double>(0);
    const double speed = i == 1 ? 0.1 : 0.05;  // slow enough to be explained by friction and load
    bench.world().spoil_inputs = [moved, i, &bench, speed](bridge::Inputs& inputs) {
      *moved += speed * bench.setting().told.period_s;
      inputs.raw_counts[i] =
          simulator::wrap_24_bit(std::int64_t{inputs.raw_counts[i]} + counts(bench, i, *moved));
    };
    wanted.reasons = {because(crane_CAUSE_BRAKE_DID_NOT_CLOSE), latched(crane_LATCH_BRAKED_MOTION)};
    wanted.latch_too = crane_LATCH_BRAKED_MOTION;
    wanted.latch_ms = 300;
    strike.visible = sees_error(bench, i, bench.setting().told.drives[i].brake_slip);
    wanted.detection_ms = 60;
  }
  return strike;
}

constexpr std::array kOfTheRig{
    Hazard{.number = 14, .name = "encoder counter wraps", .prepare = fine_encoders, .strike = nothing_at_all},
    Hazard{.number = 15, .name = "encoder jumps", .strike = encoder_jump},
    Hazard{.number = 16, .name = "encoder frozen", .strike = encoder_frozen},
    Hazard{.number = 17, .name = "lost counts", .strike = counts_wrong},
    Hazard{.number = 18, .name = "swing encoder fails", .strike = swing_encoder},
    Hazard{.number = 19, .name = "converter stuck, wrong sign", .strike = converter},
    Hazard{.number = 20, .name = "following error", .strike = weak_drive},
    Hazard{.number = 21, .name = "overspeed", .strike = overspeed},
    Hazard{.number = 22, .name = "position limit", .strike = position_limit},
    Hazard{.number = 23, .name = "swing limit", .strike = swing_limit},
    Hazard{.number = 24, .name = "brake fails to close", .prepare = broken_brake, .strike = brake_stays_open},
    Hazard{.number = 25, .name = "brake fails to open", .strike = brake_closes},
    Hazard{.number = 41, .name = "bridge beside a mad supervisor", .strike = needs_nobody},
    Hazard{.number = 31, .name = "e-stop and limit switches", .strike = inputs_pressed},
};

}  // namespace

std::span<const Hazard> rig_hazards() { return kOfTheRig; }

}  // namespace crane::campaign
