#include "effects.hpp"

#include <algorithm>
#include <stdexcept>

namespace truth {
namespace {

/// One effect being put into a crane. `size` is the amplitude with its sign.
struct Making {
  Physics& crane;
  std::size_t axis;  ///< 0 trolley or radial, 1 slew or tangential
  double size;
  Random& random;
  Found& found;

  [[nodiscard]] Drive& drive() const { return crane.drive[axis]; }
  /// Size times the nominal of the axis, kept for the answer.
  double scaled(const std::string& name, std::array<double, 2> nominal, const std::string& unit) const {
    return say(name, size * nominal[axis], unit);
  }
  double say(const std::string& name, double value, const std::string& unit) const {
    found.parameters.push_back({name, value, unit});
    return value;
  }
};

enum class Sign { positive, either };

struct Kind {
  std::string_view name, axes;  // axes: d drives, t trolley only, s swings, n none
  Sign sign;
  bool in_library;
  std::string_view form;
  void (*make)(const Making&);
};

std::string per(const Making& m, const std::string& unit) {
  return m.axis == 0 ? unit + "/m" : unit + "/rad";
}
std::string length(const Making& m) { return m.axis == 0 ? "m" : "rad"; }

void coulomb_friction(const Making& m) {
  auto& levels = m.drive().coulomb_v;
  const std::array<double, 2> nominal{0.3, 0.22};
  const double least = 0.02 - std::min(levels[0], levels[1]);  // some friction is always left
  const double more = m.say("coulomb_v", std::max(least, m.size * nominal[m.axis]), "V");
  for (double& level : levels) level += more;
}

void viscous_friction(const Making& m) {
  auto& slopes = m.drive().viscous_vs;
  const std::array<double, 2> nominal{1.0, 0.7};
  const double least = -std::min(slopes[0], slopes[1]);
  const double more = m.say("viscous_vspm", std::max(least, m.size * nominal[m.axis]), per(m, "V s"));
  for (double& slope : slopes) slope += more;
}

void direction_asymmetry(const Making& m) {
  Drive& d = m.drive();
  const std::array<double, 2> level_v{0.5, 0.4}, slope_vs{0.8, 0.15};
  const auto change = [&](const std::string& name, std::array<double, 2>& values, double difference,
                          double least, const std::string& unit) {
    m.say(name, difference, unit);
    values = {values[0] + difference / 2, values[1] - difference / 2};
    const double lift = std::max(0.0, least - std::min(values[0], values[1]));
    for (double& value : values) value += lift;
  };
  change("coulomb_difference_v", d.coulomb_v, m.size * level_v[m.axis], 0.02, "V");
  change("viscous_difference_vspm", d.viscous_vs, m.size * slope_vs[m.axis], 0, per(m, "V s"));
}

void stribeck_friction(const Making& m) {
  m.drive().stribeck_v = m.scaled("excess_v", {0.8, 0.6}, "V");
  m.drive().stribeck_speed = m.say("decay_speed", m.axis == 0 ? 0.04 : 0.06, length(m) + "/s");
}

void position_dependent_friction(const Making& m) {
  Drive& d = m.drive();
  d.bump_v = m.scaled("amplitude_v", {0.7, 0.5}, "V");
  d.bump_distance = m.say("wavelength", m.random.uniform(0.28, 0.45) * (m.axis == 0 ? 1 : 2.2), length(m));
  d.bump_at = m.say("tight_at", m.crane.low[m.axis] + m.random.uniform(0, d.bump_distance), length(m));
}

void motor_gain(const Making& m) { m.drive().amplifier_gain = m.say("factor", 1 + 0.12 * m.size, "1"); }

void command_offset(const Making& m) { m.drive().offset_v = m.scaled("offset_v", {0.2, 0.15}, "V"); }

void command_dead_zone(const Making& m) { m.drive().dead_zone_v = m.scaled("width_v", {0.35, 0.3}, "V"); }

void command_delay(const Making& m) { m.drive().delay_s = m.scaled("delay_s", {0.035, 0.035}, "s"); }

void actuator_lag(const Making& m) { m.drive().lag_s = m.scaled("lag_s", {0.06, 0.06}, "s"); }

void torque_ripple(const Making& m) {
  Drive& d = m.drive();
  d.ripple_v = m.scaled("amplitude_v", {0.6, 0.4}, "V");
  d.ripple_distance = m.say("wavelength", m.axis == 0 ? 0.0127 : 2 * std::numbers::pi / 45, length(m));
  d.ripple_phase_rad = m.say("phase_rad", m.random.uniform(-3.1, 3.1), "rad");
}

void backlash(const Making& m) {
  m.drive().gap = m.scaled("gap", {0.006, 0.012}, length(m));
  m.drive().gap_margin = m.axis == 0 ? 1.5 : 0.3;
}

void payload_mass(const Making& m) {
  const double kg = std::max(0.2, m.crane.load_kg * (1 + 0.4 * m.size));
  m.say("mass_change_kg", kg - m.crane.load_kg, "kg");
  m.crane.load_kg = m.say("load_mass_kg", kg, "kg");
}

void cable_length(const Making& m) { m.crane.cable_error_m = m.say("length_change_m", 0.05 * m.size, "m"); }

void load_linear_drag(const Making& m) {
  m.crane.linear_drag_nspm = m.say("coefficient_nspm", 0.3 * m.size, "N s/m");
  m.crane.gust_mps = 0.05;
}

void load_quadratic_drag(const Making& m) {
  m.crane.quadratic_drag = m.say("coefficient_ns2pm2", 0.7 * m.size, "N s2/m2");
  m.crane.gust_mps = 0.05;
}

void steady_wind(const Making& m) {
  m.crane.wind_n = m.say("force_n", 0.5 * m.size, "N");
  m.crane.wind_towards_rad = m.say("direction_rad", m.random.uniform(-3.1, 3.1), "rad");
  m.crane.gust_share = 0.03;
  m.crane.gust_mps = std::max(m.crane.gust_mps, 0.02);
}

void swing_pivot_friction(const Making& m) {
  m.crane.pivot_coulomb_nm = m.say("coulomb_nm", 0.05 * m.size, "N m");
  m.crane.pivot_viscous = m.say("viscous_nmsprad", 0.08 * m.size, "N m s/rad");
}

void jib_tilt(const Making& m) { m.crane.tilt_rad = m.say("tilt_rad", 0.02 * m.size, "rad"); }

void jib_flexibility(const Making& m) {
  m.crane.drive[1].stiffness = m.say("stiffness_nmprad", 800 / m.size, "N m/rad");
}

void cable_elasticity(const Making& m) {
  m.crane.cable_stiffness_n = 250 / m.size;
  m.say("stiffness_npm", m.crane.cable_stiffness_n / m.crane.cable_m, "N/m");
}

void double_pendulum(const Making& m) {
  m.crane.hook_kg = m.say("hook_mass_kg", 0.3 * m.crane.load_kg, "kg");
  m.crane.sling_m = m.say("sling_m", std::min(0.12 * m.size, 0.3) * m.crane.cable_m, "m");
}

void swing_offset(const Making& m) {
  m.crane.swing_offset_rad[m.axis] = m.say("offset_rad", 0.015 * m.size, "rad");
}

void swing_misalignment(const Making& m) {
  m.crane.swing_misalignment_rad = m.say("angle_rad", 0.1 * m.size, "rad");
}

void swing_scale(const Making& m) { m.crane.swing_scale[m.axis] = m.say("factor", 1 + 0.08 * m.size, "1"); }

void position_scale(const Making& m) { m.drive().encoder_scale = m.say("factor", 1 + 0.05 * m.size, "1"); }

void position_drift(const Making& m) {
  m.drive().slip_per_s = m.scaled("drift_ps", {0.0015, 0.003}, length(m) + "/s");
}

void swing_delay(const Making& m) { m.crane.swing_delay_s = m.say("delay_s", 0.04 * m.size, "s"); }

void swing_moving_average(const Making& m) {
  m.crane.swing_average_s = m.say("window_s", 0.12 * m.size, "s");
}

void magnetic_detent(const Making& m) {
  Drive& d = m.drive();
  d.detent_v = m.scaled("force_v", {1.5, 1.0}, "V");
  const double low = m.crane.low[m.axis], high = m.crane.high[m.axis];
  d.detent_at = m.say("at", low + m.random.uniform(0.4, 0.6) * (high - low), length(m));
  d.detent_width = m.axis == 0 ? 0.03 : 0.06;
}

void gain_drift(const Making& m) {
  m.drive().gain_loss = m.say("final_loss", std::min(0.9, 0.35 * m.size), "1");
}

void hysteretic_force(const Making& m) {
  m.drive().hysteresis_v = m.scaled("force_v", {0.9, 0.6}, "V");
  m.drive().hysteresis_distance = m.axis == 0 ? 0.05 : 0.12;
}

void sticking_brake(const Making& m) { m.drive().sticking_v = m.scaled("friction_v", {1.0, 0.7}, "V"); }

void periodic_force(const Making& m) {
  m.drive().periodic_v = m.scaled("amplitude_v", {0.4, 0.3}, "V");
  m.drive().periodic_hz = m.say("frequency_hz", m.random.uniform(0.6, 1.3), "Hz");
}

void crosstalk(const Making& m) { m.drive().crosstalk = m.say("share", 0.25 * m.size, "1"); }

void load_periodic_force(const Making& m) {
  m.crane.load_periodic_n = m.say("amplitude_n", 0.5 * m.size, "N");
  m.crane.load_periodic_hz = m.say("frequency_hz", m.random.uniform(0.65, 1.2), "Hz");
}

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
    Kind{"command_dead_zone", "d", Sign::positive, true, "rounded corners, a tenth wider towards -",
         command_dead_zone},
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
    return false;  // its period does not show it
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
  const double draw = random.uniform();  // always, so that the other numbers do not depend on a given axis
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
  // A rig without friction cannot have less of it.
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
