#include "fault.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <set>
#include <string_view>

namespace mujoco_truth {
namespace {

std::size_t axis_number(const std::string& axis) { return axis == "slew" ? kSlew : kTrolley; }

/// Scale of the rig for the amounts of the table.
double scale_of(const std::string& name, const std::string& axis, const Rig& rig) {
  const Drive& drive = rig.drive[axis_number(axis)];
  const double weight = rig.load_mass_kg * rig.gravity_mps2;
  static const std::set<std::string> of_weight{"steady_wind", "load_periodic_force", "hand_pushes",
                                               "load_linear_drag", "load_quadratic_drag"};
  if (name == "payload_mass") return rig.load_mass_kg;
  if (name == "cable_length") return rig.cable_m;
  if (name.starts_with("swing_pivot")) return weight * rig.cable_m;
  if (of_weight.contains(name)) return weight;
  if (name == "direction_asymmetry") return std::min(drive.coulomb_pos_v, drive.coulomb_neg_v);
  if (axis == "slew" && (name == "backlash" || name == "encoder_eccentricity")) return 2;
  return 1;
}

}  // namespace

std::vector<std::string> axes_of(const FaultKind& kind, const Rig& rig) {
  const bool driven = rig.kind == Kind::tower || rig.kind == Kind::gantry, tower = rig.kind == Kind::tower;
  const auto only_if = [](bool holds) {
    return holds ? std::vector<std::string>{""} : std::vector<std::string>{};
  };
  switch (kind.where) {
    case Where::load:
      return only_if(rig.has_load());
    case Where::driven_load:
      return only_if(driven);
    case Where::tower:
      return only_if(tower);
    case Where::loaded_drive:
      if (!driven) return {};
      break;
    case Where::tower_drive:
      if (!tower) return {};
      break;
    case Where::drive:
    case Where::swing:
      break;
  }
  std::vector<std::string> axes;
  if (kind.where == Where::swing) {
    if (rig.has_swing(kRadial)) axes.emplace_back("radial");
    if (rig.has_swing(kTangential)) axes.emplace_back("tangential");
    return axes;
  }
  if (rig.drive[kTrolley].there) axes.emplace_back("trolley");
  if (rig.drive[kSlew].there) axes.emplace_back("slew");
  return axes;
}

Fault drawn_fault(const FaultKind& kind, const std::string& axis, const Rig& rig, Chance& chance) {
  Fault fault{kind.name, axis, kind.in_library, 0, {}};
  const double sign = kind.both_signs ? chance.sign() : 1;
  fault.amount = sign * kind.trial * scale_of(kind.name, axis, rig);
  const double wide = axis == "slew" ? 2 : 1;
  auto& s = fault.shape;
  const std::string& name = fault.name;
  if (name == "stribeck_friction") s["decay_speed"] = wide * chance.uniform(0.02, 0.1);
  if (name == "position_dependent_friction")
    s = {{"wavelength", wide * chance.uniform(0.15, 0.5)}, {"tight_at", chance.uniform(0, 0.3)}};
  if (name == "torque_ripple")
    s = {{"period", wide * chance.uniform(0.03, 0.15)}, {"phase_rad", chance.uniform(-3, 3)}};
  if (name == "backlash")
    s = {{"guide_deceleration", chance.uniform(0.3, 1)},
         {"driven_share",
          axis == "slew" ? chance.uniform(0.2, 0.6) : rig.trolley_mass_kg / rig.drive[kTrolley].inertia_kg}};
  if (name == "steady_wind")
    s["direction_rad"] = rig.kind == Kind::tower ? chance.uniform(-3, 3) : chance.sign() > 0 ? 0 : kTau / 2;
  if (name == "swing_pivot_friction") s["coulomb"] = chance.happens(0.5) ? 1 : 0;
  if (name == "double_pendulum") s["lower_length_m"] = chance.uniform(0.15, 0.4) * rig.cable_m;
  if (name == "jib_flexibility")
    s = {{"jib_share", chance.uniform(0.3, 0.7)}, {"damping_ratio", chance.uniform(0.01, 0.05)}};
  if (name == "position_drift") s["jump"] = chance.happens(0.5) ? 0 : wide * chance.uniform(0.0005, 0.002);
  if (name == "sticking_brake" || name == "hand_pushes")
    for (int i = 0; i < kStretches; ++i) {
      const double from = 8 * i + chance.uniform(1, 6);
      s["from" + std::to_string(i)] = from;
      s["to" + std::to_string(i)] = from + chance.uniform(0.4, 1.2);
      s["direction" + std::to_string(i)] = chance.uniform(0, kTau);
    }
  if (name == "periodic_force") s = {{"hz", chance.uniform(0.7, 4)}, {"phase", chance.uniform(0, kTau)}};
  if (name == "hose_hysteresis") s["way"] = wide * chance.uniform(0.1, 0.3);
  if (name == "encoder_eccentricity") s["period"] = wide * chance.uniform(0.1, 0.4);
  if (name == "load_periodic_force")
    s = {{"hz", std::sqrt(rig.gravity_mps2 / rig.cable_m) / kTau *
                    (chance.happens(0.5) ? chance.uniform(0.3, 0.8) : chance.uniform(1.25, 2.5))},
         {"direction_rad", rig.tangential ? chance.uniform(0, kTau) : 0}};
  return fault;
}

double most_of(const Fault& fault, const Rig& rig) {
  double most = kind_of(fault).most * scale_of(fault.name, fault.axis, rig);
  const Drive& drive = rig.drive[axis_number(fault.axis)];
  constexpr double kLeft = 0.8;  // largest share of the friction of the rig file that may be missing
  if (fault.amount < 0 && fault.name == "coulomb_friction")
    most = std::min(most, kLeft * std::min(drive.coulomb_pos_v, drive.coulomb_neg_v));
  if (fault.amount < 0 && fault.name == "viscous_friction")
    most = std::min(most, kLeft * std::min(drive.viscous_pos_vspm, drive.viscous_neg_vspm));
  return most;
}

const FaultKind& kind_of(const Fault& fault) {
  return *std::find_if(fault_kinds().begin(), fault_kinds().end(),
                       [&](const FaultKind& k) { return fault.name == k.name; });
}

std::map<std::string, double> Fault::parameters() const {
  if (!in_library) return {{"amount", amount}};
  const FaultKind& kind = kind_of(*this);
  if (name == "swing_pivot_friction")
    return {{shape.at("coulomb") > 0 ? "coulomb_nm" : "viscous_nmsprad", amount}};
  std::map<std::string, double> all = shape;
  all[kind.parameter] = kind.without + amount;
  return all;
}

Physics with(Physics physics, const std::vector<Fault>& faults) {
  for (const Fault& fault : faults) kind_of(fault).apply(FaultKind::Target{physics, fault});
  return physics;
}

bool confounded(const std::string& a, const std::string& b) {
  static const std::vector<std::set<std::string>> groups{
      {"command_delay", "actuator_lag"},
      {"swing_delay", "swing_moving_average"},
      {"direction_asymmetry", "jib_tilt", "command_offset"},
      {"steady_wind", "swing_offset", "jib_tilt"},
      {"stribeck_friction", "position_dependent_friction"},
      {"motor_gain", "position_scale"}};
  return std::any_of(groups.begin(), groups.end(),
                     [&](const auto& g) { return g.contains(a) && g.contains(b); });
}

}  // namespace mujoco_truth
