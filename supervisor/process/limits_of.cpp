#include "crane/supervisor/component.hpp"

#include <algorithm>
#include <string>

#include "crane/configuration/path_space.hpp"
#include "crane/plant/term.hpp"

namespace crane::supervisor {
namespace {

double count_of(const configuration::Encoder& encoder) {
  return encoder.counts_per_unit > 0 ? 1 / encoder.counts_per_unit : 0;
}

/// Raises the friction to that of the model terms: it may exceed the friction that is compensated.
void add_friction_of_model(const configuration::Rig& rig, MachineModel& machine) {
  for (const plant::TermSetting& term : rig.terms) {
    if (term.name != "drive_friction") continue;
    const auto value = [&term](const std::string& name) {
      const auto found = term.parameters.find(name);
      return found == term.parameters.end() ? 0.0 : found->second;
    };
    const plant::Axis axis = plant::drive_axis(term.axis);
    const auto raise = [&value](const std::string& sign, MachineModel::Friction& friction) {
      friction.rest_v =
          std::max({friction.rest_v, value("coulomb_" + sign + "_v"), value("stiction_" + sign + "_v")});
      friction.viscous_vs_per_unit =
          std::max(friction.viscous_vs_per_unit, value("viscous_" + sign + "_vspm"));
    };
    raise("positive", machine.friction_positive[axis]);
    raise("negative", machine.friction_negative[axis]);
  }
}

/// After 2 / ratio ticks, the transient of a second-order Butterworth filter is exp(-2 sqrt(2) pi) = 1.4e-4
/// of its initial size.
void filter_swing(double cutoff_ratio, MachineModel& machine) {
  machine.swing_filter = control::butterworth_low_pass(cutoff_ratio);
  if (cutoff_ratio > 0) machine.swing_filter_ticks = static_cast<int>(std::ceil(2 / cutoff_ratio));
}

MachineModel machine_of(const configuration::Rig& rig) {
  MachineModel machine{.known = rig.limits.model_checks, .crane = rig.design.crane};
  for (std::size_t i = 0; i < kAxes; ++i) {
    const auto& friction = rig.design.friction[i];
    machine.friction_positive[i] = {std::max(friction.coulomb_positive_v, friction.stiction_positive_v),
                                    friction.viscous_positive_vspm};
    machine.friction_negative[i] = {std::max(friction.coulomb_negative_v, friction.stiction_negative_v),
                                    friction.viscous_negative_vspm};
    machine.resolution[i] = count_of(rig.encoders[i]);
  }
  add_friction_of_model(rig, machine);
  const bool load = rig.design.crane.load_mass_kg > 0;
  for (std::size_t i = 0; i < 2; ++i) {
    machine.swing_resolution_rad[i] = count_of(rig.encoders[kAxes + i]);
    machine.swing_measured[i] = load && machine.swing_resolution_rad[i] > 0;
  }
  machine.swing_filtered = rig.sensing.filter_swing_angle;
  if (machine.swing_filtered) filter_swing(rig.sensing.swing_filter_ratio, machine);
  machine.cable_measured = machine.resolution[plant::kHoist] > 0;
  machine.cable_m = rig.start.position[plant::kHoist];
  return machine;
}

}  // namespace

Limits limits_of(const configuration::Rig& rig) {
  Limits limits{rig.limits};
  for (std::size_t i = 0; i < kAxes; ++i) limits.axis[i] = rig.drives[i];
  limits.period_s = rig.period_s;
  limits.relay_timeout_s = rig.wiring.relay_timeout_s;
  limits.demand_stale_after_ticks = rig.ticks_in(rig.limits.demand_stale_after_s);
  limits.machine = machine_of(rig);
  limits.clearance = rig.clearance;
  limits.zones = rig.zones;
  limits.path_space = configuration::path_space_of(rig);
  for (std::size_t i = 0; i < kAxes; ++i) {
    const auto& drive = rig.drives[i];
    if (!drive.present) continue;
    limits.reference_acceleration[i] = drive.reference_acceleration;
    limits.largest_follow_jump[i] =
        drive.reference_speed * drive.reference_speed / (2 * drive.reference_acceleration);
  }
  return limits;
}

}  // namespace crane::supervisor
