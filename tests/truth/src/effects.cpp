#include "effects.hpp"

#include <algorithm>
#include <stdexcept>

#include "effect_forms.hpp"

namespace truth {
namespace {

enum class Sign { positive, either };

struct Kind {
  std::string_view name, axes;  // axes: d drives, t trolley only, s swings, n none
  Sign sign;
  bool in_library;
  std::string_view form;
  void (*make)(const Making&);
};

constexpr std::array kKinds{
    Kind{"coulomb_friction", "d", Sign::either, true, "LuGre level of both directions changed",
         coulomb_friction},
    Kind{"viscous_friction", "d", Sign::either, true, "slope of both directions changed", viscous_friction},
    Kind{"direction_asymmetry", "d", Sign::either, true, "+ direction has more, - as much less",
         direction_asymmetry},
    Kind{"stribeck_friction", "d", Sign::positive, true, "LuGre, excess exp(-|v|/v_s)", stribeck_friction},
    Kind{"position_dependent_friction", "d", Sign::positive, true, "narrow bumps exp(1.5 (cos - 1))",
         position_dependent_friction},
    Kind{"motor_gain", "d", Sign::either, true, "amplifier gain", motor_gain},
    Kind{"command_offset", "d", Sign::either, true, "constant", command_offset},
    Kind{"command_dead_zone", "d", Sign::positive, true,
         "rounded corners, a tenth wider towards -, the mean is its width", command_dead_zone},
    Kind{"command_delay", "d", Sign::positive, true, "exact in continuous time", command_delay},
    Kind{"actuator_lag", "d", Sign::positive, true, "two poles, 0.55 and 0.45 of the sum of time constants",
         actuator_lag},
    Kind{"torque_ripple", "d", Sign::positive, true,
         "cogging over the motor's turn, a quarter of second harmonic", torque_ripple},
    Kind{"backlash", "d", Sign::positive, true,
         "two masses with contact, driven side with friction of its own", backlash},
    Kind{"payload_mass", "n", Sign::either, true, "load mass", payload_mass},
    Kind{"cable_length", "n", Sign::either, true, "true length minus the encoder's", cable_length},
    Kind{"load_linear_drag", "n", Sign::positive, true, "of the speed through gusty air", load_linear_drag},
    Kind{"load_quadratic_drag", "n", Sign::positive, true, "of the speed through gusty air",
         load_quadratic_drag},
    Kind{"steady_wind", "n", Sign::positive, true, "with gusts of 3 %", steady_wind},
    Kind{"swing_pivot_friction", "n", Sign::positive, true, "LuGre with viscous part, both joints",
         swing_pivot_friction},
    Kind{"jib_tilt", "n", Sign::either, true, "gravity turned; positive: tip low", jib_tilt},
    Kind{"jib_flexibility", "n", Sign::positive, true,
         "two inertias (0.35 at the motor) with a torsion spring", jib_flexibility},
    Kind{"cable_elasticity", "n", Sign::positive, true,
         "E A, length free, tension never pushes; encoder sees the "
         "unstretched length",
         cable_elasticity},
    Kind{"double_pendulum", "n", Sign::positive, true,
         "hook and load, coupled in full; the encoder sees the upper "
         "cable",
         double_pendulum},
    Kind{"swing_offset", "s", Sign::either, true, "constant", swing_offset},
    Kind{"swing_misalignment", "n", Sign::either, true,
         "sensor turned about the vertical, exact in large angles", swing_misalignment},
    Kind{"swing_scale", "s", Sign::either, true, "factor", swing_scale},
    Kind{"position_scale", "d", Sign::either, true, "factor", position_scale},
    Kind{"position_drift", "d", Sign::either, true, "counts lost at random instants, two a second",
         position_drift},
    Kind{"swing_delay", "n", Sign::positive, true, "exact in continuous time, both angles", swing_delay},
    Kind{"swing_moving_average", "n", Sign::positive, true, "mean of samples of 1 ms over the window before",
         swing_moving_average},
    Kind{"magnetic_detent", "d", Sign::positive, false, "force of a potential well at one place",
         magnetic_detent},
    Kind{"gain_drift", "d", Sign::positive, false, "motor gain falls with time, 15 s", gain_drift},
    Kind{"hysteretic_force", "d", Sign::positive, false, "Bouc-Wen, n = 2", hysteretic_force},
    Kind{"sticking_brake", "d", Sign::positive, false, "brake that drags at random times", sticking_brake},
    Kind{"periodic_force", "d", Sign::positive, false, "sine of time on the motor", periodic_force},
    Kind{"slew_crosstalk", "t", Sign::either, false, "slew command gets into the trolley's drive", crosstalk},
    Kind{"load_periodic_force", "n", Sign::positive, false, "sine of time along the jib on the load",
         load_periodic_force},
};

const std::array<std::string, 2> kDriveNames{"trolley", "slew"}, kSwingNames{"radial", "tangential"};

std::vector<std::string> axes_of(std::string_view code) {
  if (code == "d") return {kDriveNames[0], kDriveNames[1]};
  if (code == "s") return {kSwingNames[0], kSwingNames[1]};
  if (code == "t") return {kDriveNames[0]};
  return {""};
}

std::size_t index(const std::string& axis) {
  return axis == kDriveNames[1] || axis == kSwingNames[1] ? 1 : 0;
}

bool has(const Physics& p, std::string_view code, std::size_t axis) {
  if (code == "d") return p.drive[axis].present;
  if (code == "t") return p.drive[0].present && p.drive[1].present;
  return axis == 0 ? p.radial : p.tangential;
}

bool possible(const Kind& kind, const Physics& p) {
  if (kind.axes != "n") return has(p, kind.axes, 0) || has(p, kind.axes, 1);
  if (kind.name == "jib_flexibility") return p.drive[1].present;
  if (kind.name == "swing_misalignment") return p.tangential;
  if (kind.name == "payload_mass" && p.kind == RigKind::pendulum)
    return false;  // the swing period does not show the effect
  return p.load_kg > 0;
}

const Kind& find(const std::string& name) {
  for (const Kind& kind : kKinds)
    if (kind.name == name) return kind;
  throw std::invalid_argument("effect = " + name + ": no such effect");
}

std::string choose_axis(const Kind& kind, const Hidden& hidden, const Physics& p, Random& random) {
  std::vector<std::string> fitting;
  for (const std::string& axis : axes_of(kind.axes))
    if (axis.empty() || has(p, kind.axes, index(axis))) fitting.push_back(axis);
  if (fitting.empty() || !possible(kind, p))
    throw std::invalid_argument("effect = " + hidden.name + ": this rig cannot have it");
  // drawn in any case, so that the other random numbers do not depend on a given axis
  const double draw = random.uniform();
  if (hidden.axis.empty())
    return fitting[static_cast<std::size_t>(draw * static_cast<double>(fitting.size()))];
  if (std::find(fitting.begin(), fitting.end(), hidden.axis) == fitting.end())
    throw std::invalid_argument("effect = " + hidden.name + ": axis = " + hidden.axis +
                                ": not one of this rig's");
  return hidden.axis;
}

}  // namespace

Found apply(const Hidden& hidden, Physics& physics, std::uint64_t seed) {
  const Kind& kind = find(hidden.name);
  Random random{seed, "effect " + hidden.name};
  Found found{hidden.name,
              choose_axis(kind, hidden, physics, random),
              hidden.amplitude,
              kind.in_library,
              std::string{kind.form},
              {}};
  const double sign = random.sign();
  if (kind.sign == Sign::positive && hidden.amplitude < 0)
    throw std::invalid_argument("effect = " + hidden.name + ": amplitude has to be >= 0");
  // A rig without friction cannot have less friction.
  const bool less = kind.sign == Sign::either && !(hidden.amplitude < 0) && sign < 0;
  const bool bare = kind.axes == "d" && physics.drive[index(found.axis)].coulomb_v[0] <= 0;
  const bool needs_friction = hidden.name == "coulomb_friction" || hidden.name == "viscous_friction";
  const double scale = kind.axes == "n" || kind.axes == "s" ? physics.load_effects : 1;
  const double size = scale * (less && !(bare && needs_friction) ? -hidden.amplitude : hidden.amplitude);
  if (size == 0) return found;
  kind.make({physics, index(found.axis), size, random, found});
  return found;
}

const std::vector<EffectKind>& effect_kinds() {
  static const std::vector<EffectKind> kinds = [] {
    std::vector<EffectKind> list;
    for (const Kind& kind : kKinds)
      list.push_back({std::string{kind.name}, axes_of(kind.axes), kind.in_library, std::string{kind.form}});
    return list;
  }();
  return kinds;
}

}  // namespace truth
