#include <algorithm>
#include <array>
#include <cstdio>

#include "write.hpp"

namespace mujoco_truth {
namespace {

/// Counts in the rig file when its author does not know the sensor.
constexpr double kAssumedCounts = 3000;

/// A floating-point number in TOML: a whole number gets a decimal point.
std::string line(const std::string& key, double value) {
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%.17g", value);
  std::string number = text.data();
  if (number.find_first_of(".en") == std::string::npos) number += ".0";
  return key + " = " + number + "\n";
}
std::string line(const std::string& key, std::size_t value) {
  return key + " = " + std::to_string(value) + "\n";
}
std::string line(const std::string& key, const std::string& value) { return key + " = \"" + value + "\"\n"; }

/// The limits are so far away that they contain no information about the position of the axis.
std::string drive_toml(const Rig& rig, std::size_t axis) {
  const Drive& d = rig.drive[axis];
  const std::string m = axis == kSlew ? "_rad" : "_m", name = kAxisNames[axis];
  return "\n[drive." + name + "]\n" + line("dac_channel", axis) + line("low_limit" + m, d.low_m - 1) +
         line("high_limit" + m, d.high_m + 1) + line("soft_margin" + m, 0.05 * (d.high_m - d.low_m)) +
         line("max_speed" + m + "ps", 6.0) + line("brake_deceleration" + m + "ps2", 1000.0) +
         line("reference_speed" + m + "ps", 0.3) + line("reference_acceleration" + m + "ps2", 0.5) +
         "\n[encoder." + name + "]\n" + line("channel", axis) + line("counts_per" + m, d.counts_per_m);
}

std::string friction_toml(const Drive& d, const std::string& axis) {
  return "\n[[model.terms]]\n" + line("name", std::string{"drive_friction"}) + line("axis", axis) +
         line("viscous_positive_vspm", d.viscous_pos_vspm) +
         line("viscous_negative_vspm", d.viscous_neg_vspm) + line("coulomb_positive_v", d.coulomb_pos_v) +
         line("coulomb_negative_v", d.coulomb_neg_v);
}

}  // namespace

std::string rig_toml(const Set& set) {
  const Rig& rig = set.rig;
  std::string text = line("name", std::string{"laboratory"}) + line("kind", std::string{name_of(rig.kind)}) +
                     line("period_s", std::min(0.1, 1 / set.nuisance.rate_hz)) + "\n[plant]\n" +
                     line("gravity_mps2", rig.gravity_mps2);
  const Drive &trolley = rig.drive[kTrolley], &slew = rig.drive[kSlew];
  if (trolley.there)
    text += line("trolley_inertia_kg", trolley.inertia_kg) + line("trolley_mass_kg", rig.trolley_mass_kg) +
            line("trolley_gain_mps2pv", trolley.gain_mps2pv);
  if (slew.there)
    text += line("jib_inertia_kgm2", slew.inertia_kg) + line("slew_gain_radps2pv", slew.gain_mps2pv);
  if (rig.has_load()) text += line("load_mass_kg", rig.load_mass_kg);
  if (rig.hoist) text += line("hoist_gain_mpspv", 0.05) + line("hoist_lag_s", 0.1);
  for (std::size_t i = 0; i < kAxes; ++i)
    if (rig.drive[i].there) text += friction_toml(rig.drive[i], kAxisNames[i]);
  for (std::size_t i = 0; i < kAxes; ++i)
    if (rig.drive[i].there) text += drive_toml(rig, i);
  if (rig.hoist)
    text +=
        "\n[drive.hoist]\ndac_channel = 2\nlow_limit_m = 0.1\nhigh_limit_m = 4.0\nsoft_margin_m = 0.1\n"
        "max_speed_mps = 0.6\nbrake_deceleration_mps2 = 5.0\nreference_speed_mps = 0.2\n"
        "reference_acceleration_mps2 = 0.5\n\n[encoder.hoist]\nchannel = 2\ncounts_per_m = 160000.0\n";
  const double stated = set.nuisance.states_resolution ? rig.swing_counts_per_rad : kAssumedCounts;
  const char* names[] = {"swing_radial", "swing_tangential"};
  for (std::size_t i = 0; i < kSwings; ++i)
    if (rig.has_swing(i))
      text += std::string{"\n[encoder."} + names[i] + "]\nchannel = " + std::to_string(3 + i) + "\n" +
              line("counts_per_rad", stated);
  text += "\n[start]\n";
  if (trolley.there) text += line("trolley_position_m", (trolley.low_m + trolley.high_m) / 2);
  if (rig.has_load()) text += line("cable_length_m", rig.cable_m);
  if (rig.kind == Kind::pendulum) text += line("swing_radial_rad", 0.1);
  return text;
}

}  // namespace mujoco_truth
