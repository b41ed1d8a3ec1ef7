#include "crane/twin/hypothesis.hpp"

#include <algorithm>
#include <cmath>

namespace crane::twin {
namespace {

using configuration::Rig;
using configuration::RigKind;

constexpr double kFriction_v = 0.1, kMuchFriction_v = 0.4, kGain = 0.05, kMuchGain = 0.1, kSlip = 0.01,
                 kOffset_rad = 0.01;
constexpr double kPayloadShare = 0.1, kCableShare = 0.03;

Hypothesis hypothesis(const std::string& cause, const std::string& axis, const std::string& parameter,
                      double null, double reference, const std::string& unit, const std::string& remedy) {
  return {cause, axis, {{cause, axis, {{parameter, null + reference}}}}, {}, reference, false, unit, remedy};
}

/// Coulomb friction of the axis in the rig file, minimum of both directions, V.
double dry_friction_v(const Rig& rig, const std::string& axis) {
  double sum = 0;
  for (const plant::TermSetting& term : rig.terms) {
    const auto positive = term.parameters.find("coulomb_positive_v");
    const auto negative = term.parameters.find("coulomb_negative_v");
    if (term.name == "drive_friction" && term.axis == axis && positive != term.parameters.end() &&
        negative != term.parameters.end())
      sum += std::min(positive->second, negative->second);
  }
  return sum;
}

/// The effect of Coulomb friction is not proportional to its size, because friction can hold a drive.
/// Therefore there are several reference sizes of either sign.
void add_dry_friction(std::vector<Hypothesis>& list, const Rig& rig, const std::string& axis,
                      const std::string& remedy) {
  const double most_lost_v = 0.6 * dry_friction_v(rig, axis);
  const auto add = [&](double size_v) {
    list.push_back(hypothesis("coulomb_friction", axis, "level_v", 0, size_v, "V", remedy));
    list.back().only_near = size_v != kFriction_v;
  };
  double lost_v = 0;
  for (const double size_v : {kFriction_v, 2 * kFriction_v, kMuchFriction_v}) {
    add(size_v);
    const double less_v = std::min(size_v, most_lost_v);
    if (less_v >= kFriction_v && less_v > lost_v) add(-less_v);
    lost_v = less_v;
  }
}

void add_drive(std::vector<Hypothesis>& list, const Rig& rig, const std::string& axis,
               const configuration::Drive& drive) {
  const bool slew = axis == "slew";
  const double viscous = kFriction_v / std::max(drive.reference_speed, 1e-3);
  const std::string look =
      "check bearings, guides and brake of the " + axis + ", then run crane identify friction";
  add_dry_friction(list, rig, axis, look);
  list.push_back(hypothesis("viscous_friction", axis, "vspm", 0, viscous, slew ? "V s/rad" : "V s/m", look));
  // The effect of the gain is not proportional either: a weaker drive is held longer by friction.
  for (const double gain : {kGain, kMuchGain, -kGain, -kMuchGain}) {
    list.push_back(hypothesis("motor_gain", axis, "factor", 1, gain, "1",
                              "check amplifier, supply and motor of the " + axis));
    list.back().only_near = gain != kGain;
  }
  Hypothesis slipping;
  slipping.cause = "position_drift";
  slipping.axis = axis;
  slipping.reference = kSlip;
  slipping.unit = slew ? "rad/rad" : "m/m";
  slipping.remedy = "check the coupling of the encoder of the " + axis + ", then home it";
  slipping.slip[slew ? diagnosis::kSlewAngle : diagnosis::kTrolleyPosition] = kSlip;
  list.push_back(slipping);
}

void add_swing_offset(std::vector<Hypothesis>& list, const std::string& axis) {
  list.push_back(hypothesis("swing_offset", axis, "offset_rad", 0, kOffset_rad, "rad",
                            "let the load hang at rest and zero the swing encoder again"));
}

}  // namespace

std::vector<Hypothesis> hypotheses_for(const Rig& rig) {
  std::vector<Hypothesis> list;
  const auto& trolley = rig.drives[plant::kTrolley];
  const auto& slew = rig.drives[plant::kSlew];
  if (trolley.present) add_drive(list, rig, "trolley", trolley);
  if (slew.present) add_drive(list, rig, "slew", slew);
  if (!rig.has_load()) return list;
  if (trolley.present || slew.present)
    list.push_back(hypothesis("payload_mass", "", "delta_kg", 0, kPayloadShare * rig.plant.load_mass_kg, "kg",
                              "weigh the load and correct load_mass_kg in the rig file"));
  list.push_back(hypothesis("cable_length", "", "delta_m", 0, kCableShare * rig.start.position[plant::kHoist],
                            "m", "measure from the jib to the load's centre and home the hoist"));
  add_swing_offset(list, "radial");
  if (rig.kind == RigKind::tower) add_swing_offset(list, "tangential");
  return list;
}

}  // namespace crane::twin
