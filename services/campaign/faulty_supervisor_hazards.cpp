/// Hazards 41 and 43: commands that a correct supervisor never gives. The bridge must detect their effects
/// without the supervisor.
#include "campaign/evidence.hpp"
#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

/// Falsifies crane/command: opens the brake of one axis and drives this axis at `volts_v`. Falsifies
/// crane/state, too, so that the supervisor sees a bridge that obeys its genuine commands and does not stop
/// the crane. The judge ignores the status of the supervisor. @param all_axes  true: opens every brake
Injection faulty_supervisor(Bench& bench, double volts_v, bool all_axes) {
  bench.publish_fault = [i = bench.axis(), volts_v, all_axes, before = 0.0, released = AxisFlags{}](
                            const topics::Description& topic, void* sample) mutable {
    if (topic.name == topics::state.description.name) {
      auto& state = *static_cast<msg::State*>(sample);
      for (std::size_t k = 0; k < kAxes; ++k) {
        state.applied_v[k] = 0;
        state.brake_closed[k] = !released[k];
      }
      return true;
    }
    if (topic.name != topics::command.description.name) return false;
    auto& command = *static_cast<msg::Command*>(sample);
    before += std::clamp(volts_v - before, -2.0, 2.0);
    for (std::size_t k = 0; k < kAxes; ++k) {
      released[k] = command.brake_release[k];
      command.brake_release[k] = k == i || all_axes;
      command.drive_v[k] = k == i ? before : 0;
    }
    command.watchdog_permission = true;
    return true;
  };
  return {.expectation = {.supervisor_faulty = true}, .watched_s = 4};
}

constexpr double kRampStep_v = 2;  // largest change of the voltage per tick in faulty_supervisor()

double ramp_ms(double from_v, double to_v) { return 10 * std::ceil(std::abs(to_v - from_v) / kRampStep_v); }

/// Detection time: one tick after the axis cannot stop before its limit, is 10 % too fast, or the load swings
/// 1.5 times its limit.
Injection drives_past_its_limit(Bench& bench, Random& random) {
  Injection injection = faulty_supervisor(bench, direction(bench) * random.between(3, 8), false);
  injection.expectation.reasons = {latched(crane_LATCH_POSITION)};
  injection.expectation.detection_ms = 10;
  injection.visible = crosses_limit(bench, latched(crane_LATCH_POSITION));
  return injection;
}

Injection swings_past_its_limit(Bench& bench) {
  constexpr double kAboveLimit = 1.9;  // swing / limit of the supervisor; the limit of the bridge is 1.5
  Injection injection = faulty_supervisor(bench, 0, true);
  push(bench, kAboveLimit * bench.setting().configured.limits.swing_limit_rad);
  injection.expectation.reasons = {latched(crane_LATCH_SWING)};
  injection.expectation.detection_ms = 10;
  injection.visible = crosses_limit(bench, latched(crane_LATCH_SWING));
  return injection;
}

/// Detection time: ramp of the voltage; time for 5 mm (docs/hardware.md) from rest; two ticks. The time for
/// 5 mm applies the smallest gain to the voltage less 1.5 times the friction, 0.5 V and the pull of the load
/// at its swing limit.
double frozen_due_ms(const Bench& bench, double volts_v) {
  const auto& rig = bench.setting().configured;
  const auto& p = rig.plant;
  const std::size_t i = bench.axis();
  const auto& friction = rig.design.friction[i];
  const double rest_v = std::max({friction.coulomb_positive_v, friction.coulomb_negative_v,
                                  friction.stiction_positive_v, friction.stiction_negative_v});
  const double pull_n = p.load_mass_kg * p.gravity_mps2 * std::sin(rig.limits.swing_limit_rad);
  const double largest_radius_m = rig.drives[0].present ? rig.drives[0].high_limit : 0;
  const double outside_kgm2 = (p.trolley_mass_kg + p.load_mass_kg) * largest_radius_m * largest_radius_m;
  const std::array<double, 3> gains{
      p.trolley_gain_mps2pv * p.trolley_inertia_kg / (p.trolley_inertia_kg + p.load_mass_kg),
      p.slew_gain_radps2pv * p.jib_inertia_kgm2 / (p.jib_inertia_kgm2 + outside_kgm2),
      p.hoist_gain_mpspv / p.hoist_lag_s};
  const std::array<double, 3> pulls_v{pull_n / p.trolley_inertia_kg / p.trolley_gain_mps2pv,
                                      pull_n * largest_radius_m / p.jib_inertia_kgm2 / p.slew_gain_radps2pv,
                                      0};
  const double net_v = std::abs(volts_v) - 0.5 - 1.5 * rest_v - pulls_v[i];
  const double slowed = i == 2 ? 1.5 : 1;  // lag of the hoist
  const double motion_ms = 1000 * slowed * std::sqrt(2 * 0.005 / (gains[i] * net_v));
  return std::ceil((ramp_ms(bench.now().truth.written_v[i], volts_v) + motion_ms + 20) / 10) * 10;
}

Injection drives_with_dead_encoder(Bench& bench) {
  const double volts_v = direction(bench) * 8;
  Injection injection = faulty_supervisor(bench, volts_v, true);
  freeze(bench, bench.axis());
  injection.expectation.reasons = {latched(crane_LATCH_ENCODER_FROZEN), latched(crane_LATCH_DRIVE_RESPONSE)};
  injection.expectation.detection_ms = frozen_due_ms(bench, volts_v);
  return injection;
}

/// The drive moves against its voltage. Detection time: ramp of the voltage; 120 ms in which earlier commands
/// may explain the motion; 50 ms until the axis has speed; three consecutive states; two ticks.
Injection drives_with_reversed_sign(Bench& bench) {
  const std::size_t i = bench.axis();
  const double volts_v = -direction(bench) * 5;
  Injection injection = faulty_supervisor(bench, volts_v, true);
  bench.rig().change_outputs = [i](bridge::Outputs& outputs) {
    outputs.drive_v[i] = -2 * outputs.drive_v[i];
  };
  injection.expectation.reasons = {latched(crane_LATCH_DRIVE_RESPONSE), latched(crane_LATCH_ENCODER_FROZEN)};
  injection.expectation.detection_ms = ramp_ms(bench.now().truth.written_v[i], volts_v) + 120 + 50 + 30 + 20;
  return injection;
}

/// The axis creeps with closed brake. Detection time: two ticks after the axis has moved by `brake_slip`.
Injection creeps_with_closed_brake(Bench& bench) {
  const std::size_t i = bench.axis();
  bench.request(crane_REQUEST_ESTOP);
  bench.run(0.5);
  auto moved = std::make_shared<double>(0);
  const double speed = i == 0   ? 0.05
                       : i == 1 ? 0.1
                                : 0.02;  // slow enough that friction and load can explain it
  bench.rig().change_inputs = [moved, i, &bench, speed](bridge::Inputs& inputs) {
    *moved += speed * bench.setting().configured.period_s;
    inputs.raw_counts[i] =
        simulator::wrap_24_bit(std::int64_t{inputs.raw_counts[i]} + counts(bench, i, *moved));
  };
  return {.expectation = {.reasons = {latched(crane_LATCH_BRAKED_MOTION)},
                          .detection_ms = 20,
                          .position_is_wrong = true,
                          .supervisor_faulty = true,
                          .bridge_must_latch = crane_LATCH_BRAKED_MOTION,
                          .independent_ms = 20,
                          // the run continues although the crane was already stopped
                          .brakes_do_not_close = true},
          .watched_s = 1.5,
          .visible = sees_error(bench, i, bench.setting().configured.drives[i].brake_slip)};
}

Injection bridge_alone(Bench& bench, Random& random) {
  switch (random.pick(5)) {
    case 0:
      return drives_past_its_limit(bench, random);
    case 1:
      return swings_past_its_limit(bench);
    case 2:
      return drives_with_dead_encoder(bench);
    case 3:
      if (bench.axis() != 2) return drives_with_reversed_sign(bench);
      [[fallthrough]];
    default:
      return creeps_with_closed_brake(bench);
  }
}

/// A foreign program forges commands of the supervisor. The fault is visible when the voltage is outside the
/// range from 0 V to the genuine voltage. Detection time: the bridge obeys in the next tick and reports the
/// voltage one tick later; two consecutive states prove the forgery.
Injection forged(Bench& bench, Random& random) {
  constexpr double kTolerance_v = 0.2;  // converter steps and an error of the scale
  const std::size_t i = bench.axis();
  const double volts_v = random.sign() * random.between(2, 8);
  auto shows = std::make_shared<bool>(false);
  bench.publish_fault =
      falsify(topics::command, [i, volts_v, shows, before = 0.0](msg::Command& command) mutable {
        before += std::clamp(volts_v - before, -kRampStep_v, kRampStep_v);
        const double own_v = command.drive_v[i];
        *shows = *shows || before < std::min(0.0, own_v) - kTolerance_v ||
                 before > std::max(0.0, own_v) + kTolerance_v;
        command.drive_v[i] = before;
        command.brake_release[i] = command.watchdog_permission = true;
      });
  return {.expectation = {.reasons = {because(crane_CAUSE_SECOND_WRITER)},
                          .detection_ms = 40,
                          .supervisor_gone = true},
          .watched_s = 0.5,
          .visible = [shows] { return *shows; }};
}

constexpr std::array kFaultySupervisorHazards{
    Hazard{.number = 41, .name = "supervisor faulty", .inject = bridge_alone},
    Hazard{.number = 43, .name = "commands forged under the supervisor's name", .inject = forged},
};

}  // namespace

std::span<const Hazard> faulty_supervisor_hazards() { return kFaultySupervisorHazards; }

}  // namespace crane::campaign
