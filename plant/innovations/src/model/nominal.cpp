#include <cmath>
#include <numbers>

#include "model/crane_model.hpp"

namespace crane::innovations {
namespace {

using plant::TermSetting;

double get(const TermSetting& term, const char* name, double otherwise = 0) {
  const auto found = term.parameters.find(name);
  return found == term.parameters.end() ? otherwise : found->second;
}

void add_friction(const TermSetting& term, Nominal::Friction& f) {
  constexpr std::array kSides{"positive", "negative"};
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string side = kSides[k];
    f.dry[k] += get(term, ("coulomb_" + side + "_v").c_str());
    f.viscous[k] += get(term, ("viscous_" + side + "_vspm").c_str());
    f.excess[k] += std::max(0.0, get(term, ("stiction_" + side + "_v").c_str()) - f.dry[k]);
  }
  f.excess_speed = get(term, "stiction_speed", 0.005);
}

/// Amounts that add to the parameter of the same meaning.
bool add_axis_term(const TermSetting& term, std::size_t i, Values& v) {
  if (term.name == "coulomb_friction")
    v[of_axis(i, kCoulomb)] += get(term, "level_v");
  else if (term.name == "viscous_friction")
    v[of_axis(i, kViscous)] += get(term, "vspm");
  else if (term.name == "motor_gain")
    v[of_axis(i, kGain)] += get(term, "factor", 1) - 1;
  else if (term.name == "command_offset")
    v[of_axis(i, kOffset)] += get(term, "offset_v");
  else if (term.name == "command_dead_zone")
    v[of_axis(i, kDeadZone)] += get(term, "width_v");
  else if (term.name == "command_delay")
    v[of_axis(i, kDelay)] += get(term, "delay_s");
  else if (term.name == "position_scale")
    v[of_axis(i, kPositionScale)] += get(term, "factor", 1) - 1;
  else
    return false;
  return true;
}

bool add_load_term(const TermSetting& term, Values& v) {
  if (term.name == "payload_mass")
    v[of_load(kMass)] += get(term, "delta_kg");
  else if (term.name == "cable_length")
    v[of_load(kCable)] += get(term, "delta_m");
  else if (term.name == "load_linear_drag")
    v[of_load(kLinearDrag)] += get(term, "coefficient_nspm");
  else if (term.name == "load_quadratic_drag")
    v[of_load(kQuadraticDrag)] += get(term, "coefficient_ns2pm2");
  else if (term.name == "jib_tilt")
    v[of_load(kTilt)] += get(term, "angle_rad");
  else if (term.name == "swing_delay" && term.axis.empty())
    v[of_load(kSwingDelay)] += get(term, "delay_s");
  else if (term.name == "swing_moving_average" && term.axis.empty())
    v[of_load(kSwingAverage)] += get(term, "window_s");
  else
    return false;
  return true;
}

bool add_swing_term(const TermSetting& term, Values& v) {
  bool known = false;
  for (std::size_t k = 0; k < 2; ++k) {
    if (!term.axis.empty() && term.axis != kSwingNames[k]) continue;
    known = true;
    if (term.name == "swing_pivot_friction") {
      v[of_load(kPivotViscous + k)] += get(term, "viscous_nmsprad");
      v[of_load(kPivotDry + k)] += get(term, "coulomb_nm");
    } else if (term.name == "swing_offset")
      v[of_load(kSwingOffset + k)] += get(term, "offset_rad");
    else if (term.name == "swing_scale")
      v[of_load(kSwingScale + k)] += get(term, "factor", 1) - 1;
    else
      known = false;
  }
  return known;
}

bool add_double_pendulum(const TermSetting& term, Values& v) {
  if (term.name != "double_pendulum") return false;
  v[of_load(kLowerShare)] = get(term, "lower_share");
  v[of_load(kLowerLength)] = get(term, "lower_length_m", 0.3);
  v[of_load(kHookRaised)] = get(term, "hook_raised_m");
  return true;
}

}  // namespace

Nominal nominal_of(const runtime::Rig& rig, Values& values) {
  Nominal nominal;
  nominal.plant = rig.plant;
  if (rig.kind == runtime::RigKind::drive_axis) nominal.plant.load_mass_kg = 0;
  nominal.cable_m = rig.start.position[plant::kHoist];
  for (const TermSetting& term : rig.terms) {
    if (term.axis == "hoist") continue;
    const std::size_t i = term.axis == "slew" ? kSlew : kTrolley;
    if (term.name == "drive_friction")
      add_friction(term, nominal.friction[i]);
    else if (term.name == "torque_ripple")
      nominal.ripples[i].push_back({get(term, "amplitude_v"), get(term, "phase_rad"),
                                    2 * std::numbers::pi / get(term, "period", 0.1)});
    else if (!add_axis_term(term, i, values) && !add_load_term(term, values) &&
             !add_swing_term(term, values) && !add_double_pendulum(term, values))
      nominal.ignored.push_back(term.name);
  }
  return nominal;
}

Layout layout_of(const runtime::Rig& rig, const std::vector<Run>& runs, bool double_pendulum) {
  Layout layout;
  std::array<bool, kChannels> measured{};
  std::array<bool, 2> volts{true, true};
  for (const Run& run : runs) {
    for (std::size_t c = 0; c < kChannels; ++c) measured[c] = measured[c] || !run.measured[c].empty();
    for (std::size_t i = 0; i < 2; ++i) volts[i] = volts[i] && !run.command[i].empty();
  }
  const bool load = rig.kind != runtime::RigKind::drive_axis && rig.plant.load_mass_kg > 0;
  const bool tower = rig.kind == runtime::RigKind::tower;
  const bool fixed = rig.kind == runtime::RigKind::pendulum;
  const std::array<bool, 4> has{measured[0], load && (measured[2] || !fixed), measured[1],
                                load && (measured[3] || tower)};
  for (std::size_t c = 0; c < 4; ++c)
    if (has[c]) layout.begin[c] = layout.size, layout.size += 3;
  constexpr std::array kSwingCoordinates{kPhi, kTheta};
  for (std::size_t k = 0; double_pendulum && k < 2; ++k)
    if (has[kSwingCoordinates[k]]) layout.lower[k] = layout.size, layout.size += 2;
  layout.volts = {volts[0] && measured[0], volts[1] && measured[1]};
  return layout;
}

}  // namespace crane::innovations
