/// Hazards 41 and 43: commands that no sane supervisor gives. The bridge has to find what they do by itself.
#include "campaign/evidence.hpp"
#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

/// The supervisor's logic has gone mad: it opens brakes, pushes for ever, and takes what the bridge does for
/// its own. What it says is no evidence. @param all_axes  opens every brake
Strike mad_supervisor(Bench& bench, double volts_v, bool all_axes) {
  bench.mad = [i = bench.axis(), volts_v, all_axes, before = 0.0, released = AxisFlags{}](
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
  return {.expectation = {.supervisor_mad = true}, .watched_s = 4};
}

constexpr double kRampStep_v = 2;  // of mad_supervisor, a tick

double ramp_ms(double from_v, double to_v) { return 10 * std::ceil(std::abs(to_v - from_v) / kRampStep_v); }

/// Due: one tick after the axis would not stop before its limit, is 10 % too fast, or the load swings 1.5
/// times its limit.
Strike drives_on(Bench& bench, Dice& dice) {
  Strike strike = mad_supervisor(bench, direction(bench) * dice.between(3, 8), false);
  strike.expectation.reasons = {latched(crane_LATCH_POSITION)};
  strike.expectation.detection_ms = 10;
  strike.visible = crosses(bench, latched(crane_LATCH_POSITION));
  return strike;
}

Strike swings_on(Bench& bench) {
  constexpr double kBeyond = 1.9;  // of the supervisor's limit; the bridge's is 1.5
  Strike strike = mad_supervisor(bench, 0, true);
  push(bench, kBeyond * bench.setting().told.limits.swing_limit_rad);
  strike.expectation.reasons = {latched(crane_LATCH_SWING)};
  strike.expectation.detection_ms = 10;
  strike.visible = crosses(bench, latched(crane_LATCH_SWING));
  return strike;
}

/// Due: until the volts have come, and the axis has gone 5 mm (docs/hardware.md) from rest under what the
/// smallest gain makes of them beyond 1.5 times the friction, half a volt, and the load at its swing limit;
/// two ticks.
double frozen_due_ms(const Bench& bench, double volts_v) {
  const auto& rig = bench.setting().told;
  const auto& p = rig.plant;
  const std::size_t i = bench.axis();
  const auto& friction = rig.design.friction[i];
  const double rest_v = std::max({friction.coulomb_positive_v, friction.coulomb_negative_v,
                                  friction.stiction_positive_v, friction.stiction_negative_v});
  const double pull_n = p.load_mass_kg * p.gravity_mps2 * std::sin(rig.limits.swing_limit_rad);
  const double reach_m = rig.drives[0].present ? rig.drives[0].high_limit : 0;
  const double outside_kgm2 = (p.trolley_mass_kg + p.load_mass_kg) * reach_m * reach_m;
  const std::array<double, 3> gains{
      p.trolley_gain_mps2pv * p.trolley_inertia_kg / (p.trolley_inertia_kg + p.load_mass_kg),
      p.slew_gain_radps2pv * p.jib_inertia_kgm2 / (p.jib_inertia_kgm2 + outside_kgm2),
      p.hoist_gain_mpspv / p.hoist_lag_s};
  const std::array<double, 3> pulls_v{pull_n / p.trolley_inertia_kg / p.trolley_gain_mps2pv,
                                      pull_n * reach_m / p.jib_inertia_kgm2 / p.slew_gain_radps2pv, 0};
  const double net_v = std::abs(volts_v) - 0.5 - 1.5 * rest_v - pulls_v[i];
  const double slowed = i == 2 ? 1.5 : 1;  // the lag of the hoist
  const double way_ms = 1000 * slowed * std::sqrt(2 * 0.005 / (gains[i] * net_v));
  return std::ceil((ramp_ms(bench.now().truth.written_v[i], volts_v) + way_ms + 20) / 10) * 10;
}

Strike pushes_a_dead_encoder(Bench& bench) {
  const double volts_v = direction(bench) * 8;
  Strike strike = mad_supervisor(bench, volts_v, true);
  freeze(bench, bench.axis());
  strike.expectation.reasons = {latched(crane_LATCH_ENCODER_FROZEN), latched(crane_LATCH_DRIVE_RESPONSE)};
  strike.expectation.detection_ms = frozen_due_ms(bench, volts_v);
  return strike;
}

/// The drive does the opposite of what it is told. Due: until the volts have come, 120 ms in which the bridge
/// takes earlier commands for the reason, 50 ms over which it looks at the speed, three states in a row, two
/// ticks.
Strike pushes_a_crossed_drive(Bench& bench) {
  const std::size_t i = bench.axis();
  const double volts_v = -direction(bench) * 5;
  Strike strike = mad_supervisor(bench, volts_v, true);
  bench.world().spoil_outputs = [i](bridge::Outputs& outputs) {
    outputs.drive_v[i] = -2 * outputs.drive_v[i];
  };
  strike.expectation.reasons = {latched(crane_LATCH_DRIVE_RESPONSE), latched(crane_LATCH_ENCODER_FROZEN)};
  strike.expectation.detection_ms = ramp_ms(bench.now().truth.written_v[i], volts_v) + 120 + 50 + 30 + 20;
  return strike;
}

/// The axis creeps under its closed brake. Due: two ticks after it has left its place by `brake_slip`.
Strike creeps_under_its_brake(Bench& bench) {
  const std::size_t i = bench.axis();
  bench.ask(crane_REQUEST_ESTOP);
  bench.run(0.5);
  auto moved = std::make_shared<double>(0);
  const double speed = i == 0   ? 0.05
                       : i == 1 ? 0.1
                                : 0.02;  // slow enough to be explained by friction and load
  bench.world().spoil_inputs = [moved, i, &bench, speed](bridge::Inputs& inputs) {
    *moved += speed * bench.setting().told.period_s;
    inputs.raw_counts[i] =
        simulator::wrap_24_bit(std::int64_t{inputs.raw_counts[i]} + counts(bench, i, *moved));
  };
  return {
      .expectation = {.reasons = {latched(crane_LATCH_BRAKED_MOTION)},
                      .detection_ms = 20,
                      .position_is_false = true,
                      .supervisor_mad = true,
                      .latch_too = crane_LATCH_BRAKED_MOTION,
                      .too_ms = 20,
                      .brakes_are_broken = true},  // the run goes on although the crane was stopped before
      .watched_s = 1.5,
      .visible = sees_error(bench, i, bench.setting().told.drives[i].brake_slip)};
}

Strike needs_nobody(Bench& bench, Dice& dice) {
  switch (dice.pick(5)) {
    case 0:
      return drives_on(bench, dice);
    case 1:
      return swings_on(bench);
    case 2:
      return pushes_a_dead_encoder(bench);
    case 3:
      if (bench.axis() != 2) return pushes_a_crossed_drive(bench);
      [[fallthrough]];
    default:
      return creeps_under_its_brake(bench);
  }
}

/// Packets under the name of the supervisor. Due once their voltage is not between 0 V and the supervisor's
/// own, which needs no explanation: the bridge obeys in the next tick, reports it in the one after that, and
/// two states in a row are the proof.
Strike forged(Bench& bench, Dice& dice) {
  constexpr double kTolerance_v = 0.2;  // converter and scale, docs/safety.md
  const std::size_t i = bench.axis();
  const double volts_v = dice.sign() * dice.between(2, 8);
  auto shows = std::make_shared<bool>(false);
  bench.mad = madness(topics::command, [i, volts_v, shows, before = 0.0](msg::Command& command) mutable {
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

constexpr std::array kOfMadSupervisors{
    Hazard{.number = 41, .name = "bridge beside a mad supervisor", .strike = needs_nobody},
    Hazard{.number = 43, .name = "commands forged under the supervisor's name", .strike = forged},
};

}  // namespace

std::span<const Hazard> mad_supervisor_hazards() { return kOfMadSupervisors; }

}  // namespace crane::campaign
