#pragma once
#include <string>

#include "crane/innovations/data.hpp"
#include "sample_crane.hpp"

namespace crane::innovations::test {

/// The rig file of SampleCrane without its effects.
inline runtime::Rig rig_of(const SampleCrane& c) {
  const bool load = c.load_kg > 0;
  std::string text =
      "name = \"sample\"\nkind = \"" + std::string{load ? "gantry" : "drive_axis"} + "\"\nperiod_s = 0.01\n";
  text += "[plant]\ntrolley_inertia_kg = " + std::to_string(c.inertia_kg) +
          "\ntrolley_mass_kg = 1.0\ntrolley_gain_mps2pv = " + std::to_string(c.gain) + "\n";
  if (load)
    text += "load_mass_kg = " + std::to_string(c.load_kg) + "\nhoist_gain_mpspv = 0.04\nhoist_lag_s = 0.15\n";
  const auto drive = [](const std::string& axis, const std::string& unit, int channel) {
    const std::string low = axis == "hoist" ? "0.4" : "-2.0";
    return "[drive." + axis + "]\ndac_channel = " + std::to_string(channel) + "\nlow_limit_" + unit + " = " +
           low + "\nhigh_limit_" + unit + " = 2.0\nsoft_margin_" + unit + " = 0.11\nmax_speed_" + unit +
           "ps = 1.2\nbrake_deceleration_" + unit + "ps2 = 17.0\nreference_speed_" + unit +
           "ps = 0.3\nreference_acceleration_" + unit + "ps2 = 1.0\n[encoder." + axis +
           "]\nchannel = " + std::to_string(channel) + "\ncounts_per_" + unit + " = 40000.0\n";
  };
  text += "[[model.terms]]\nname = \"drive_friction\"\naxis = \"trolley\"\nviscous_positive_vspm = " +
          std::to_string(c.viscous_vs) + "\nviscous_negative_vspm = " + std::to_string(c.viscous_vs) +
          "\ncoulomb_positive_v = " + std::to_string(c.coulomb_v) +
          "\ncoulomb_negative_v = " + std::to_string(c.coulomb_v) + "\n";
  text += drive("trolley", "m", 0);
  if (load) text += drive("hoist", "m", 1) + "[encoder.swing_radial]\nchannel = 2\ncounts_per_rad = 3000.0\n";
  text += "[start]\ntrolley_position_m = 0.0\n";
  if (load)
    text += "cable_length_m = " + std::to_string(c.cable_m) +
            "\n[controller]\nname = \"gain_scheduling_partial\"\n";
  return runtime::parse_rig(text, "sample.toml");
}

inline Run run_of(const SampleRows& rows, bool load) {
  Run run;
  run.name = "sample";
  run.command[0] = {rows.time_s, rows.volts};
  run.measured[0] = {rows.time_s, rows.position_m};
  if (load) run.measured[2] = {rows.time_s, rows.swing_rad};
  for (std::size_t c = 0; c < kChannels; ++c) run.resolution[c] = resolution_of(run.measured[c].value);
  return run;
}

/// Rows where `keep` says so.
template <class Keep>
Run thinned(const Run& run, Keep keep) {
  Run part = run;
  for (Series& s : part.measured) {
    Series kept;
    for (std::size_t k = 0; k < s.size(); ++k)
      if (keep(s.time_s[k])) kept.time_s.push_back(s.time_s[k]), kept.value.push_back(s.value[k]);
    s = kept;
  }
  return part;
}

}  // namespace crane::innovations::test
