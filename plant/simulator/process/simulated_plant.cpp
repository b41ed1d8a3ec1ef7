#include "crane/simulator/component.hpp"

#include "crane/bridge/bridge.hpp"
#include "crane/simulator/simulated_board.hpp"

namespace crane::simulator {

namespace {

/// Sets the zero of the encoder of an axis that must be homed: at the start, the encoder shows
/// unhomed_position(), not the true position.
void forget_zero(SimulatedRig& rig, const control::DriveLimits& drive, plant::Axis axis) {
  rig.encoders[axis].zero = plant::position(rig.start, axis) - drive.unhomed_position();
}

/// Places the limit switches at the hard limits. A limit switch that serves as homing mark is at the position
/// of the mark.
void place_switches(const control::DriveLimits& drive, SimulatedDrive& target) {
  target.low_switch = drive.low_limit;
  target.high_switch = drive.high_limit;
  if (!drive.homes()) return;
  if (drive.homing.mark == control::Mark::limit_low) target.low_switch = drive.homing.position;
  if (drive.homing.mark == control::Mark::limit_high) target.high_switch = drive.homing.position;
  if (drive.homing.mark == control::Mark::input) target.mark = drive.homing.position;
}

/// Increases the true cable length by `offset_m` without changing the measured length or the drum.
void lengthen_cable(SimulatedRig& rig, double offset_m) {
  SimulatedDrive& hoist = rig.drives[plant::kHoist];
  for (double* position : {&hoist.low_switch, &hoist.high_switch, &hoist.mark, &hoist.low_stop,
                           &hoist.high_stop, &rig.encoders[plant::kHoist].zero, &rig.start.cable_m})
    *position += offset_m;
}

}  // namespace

SimulatedRig simulated_rig_of(const configuration::Rig& rig) {
  constexpr double kStopBeyondSwitch = 0.02;  // m, rad
  SimulatedRig simulated;
  simulated.parameters = rig.plant;
  simulated.terms = rig.terms;
  simulated.period_s = rig.period_s;
  for (std::size_t i = 0; i < bridge::kDrives; ++i) {
    const auto& drive = rig.drives[i];
    auto& target = simulated.drives[i];
    target.present = drive.present;
    if (!drive.present) continue;
    target.sign = drive.sign;
    target.brake_deceleration = drive.brake_deceleration;
    target.brake_close_time_s = drive.brake_close_time_s;
    target.brake_open_time_s = drive.brake_open_time_s;
    place_switches(drive, target);
    target.low_stop = drive.low_limit - kStopBeyondSwitch;
    target.high_stop = drive.high_limit + kStopBeyondSwitch;
  }
  for (std::size_t i = 0; i < bridge::kCounters; ++i)
    if (rig.measures(i))
      simulated.encoders[i] = {.counts_per_unit = rig.encoders[i].counts_per_unit,
                               .sign = rig.encoders[i].sign,
                               .zero = -rig.encoders[i].rest_angle_rad};
  simulated.watchdog_timeout_s = rig.wiring.relay_timeout_s;
  simulated.tangential_swing = rig.kind == configuration::RigKind::tower;
  simulated.radial_swing = rig.carries_load();
  simulated.start.trolley_m = rig.start.position[plant::kTrolley];
  simulated.start.slew_rad = rig.start.position[plant::kSlew];
  simulated.start.cable_m = rig.start.position[plant::kHoist];
  lengthen_cable(simulated, rig.start.cable_length_offset_m);
  for (std::size_t i = 0; i < bridge::kDrives; ++i)
    if (rig.drives[i].homes()) forget_zero(simulated, rig.drives[i], static_cast<plant::Axis>(i));
  simulated.start.radial_rad = rig.start.swing_radial_rad;
  simulated.start.tangential_rad = rig.start.swing_tangential_rad;
  return simulated;
}

template <Method kMethod>
std::unique_ptr<runtime::Component> make_plant(const runtime::Context& context) {
  SimulatedRig rig = simulated_rig_of(context.rig);
  rig.integrator = kMethod;
  return std::make_unique<bridge::Bridge>(context, std::make_unique<SimulatedBoard>(rig));
}

runtime::ComponentSpec simulated_plant_spec(Method integrator) {
  return {.name = "plant",
          .program = "crane_plant",
          .summary =
              "The simulated plant: the loop of the bridge with simulated crane, drives, encoders, "
              "converters and brakes.",
          .source = crane_SOURCE_PLANT,
          .runs_controller = false,
          .reads = bridge::bridge_reads(),
          .writes = bridge::bridge_writes(),
          .make = integrator == Method::fast ? make_plant<Method::fast> : make_plant<Method::cvode>};
}

}  // namespace crane::simulator
