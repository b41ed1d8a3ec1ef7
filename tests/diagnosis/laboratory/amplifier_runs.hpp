#pragma once
/// Runs of the laboratory of amplifier_lab.hpp, and the error of a rig file on them.
#include "crane/diagnosis/data.hpp"
#include "laboratory/amplifier_lab.hpp"
#include "study/own_noise.hpp"
#include "verdict/drive_error.hpp"

namespace crane::diagnosis {

/// The rig file of the laboratory's axis.
inline configuration::Rig rig_of_axis() {
  configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/drive_axis.toml");
  rig.plant.trolley_gain_mps2pv = strange::Axis{}.gain_mps2pv;
  for (plant::TermSetting& term : rig.terms)
    term.parameters = {{"coulomb_positive_v", 0.34},
                       {"coulomb_negative_v", 0.34},
                       {"viscous_positive_vspm", 1.9},
                       {"viscous_negative_vspm", 1.9}};
  return rig;
}

/// Runs of the axis whose gain and friction differ from the rig file within its usual accuracy.
inline std::vector<Run> inaccurate_runs_of(strange::Axis axis, std::uint64_t seed) {
  axis.disturbance_v = 0.005;
  axis.gain_mps2pv *= 1.013;
  axis.coulomb_v *= 0.96;
  std::vector<Run> runs;
  for (const std::uint64_t run : {1, 2})
    for (Run& piece :
         load_run(strange::recorded_axis(axis, 16, 10 * seed + run), rig_of_axis(), "axis.csv").runs)
      runs.push_back(std::move(piece));
  return runs;
}

/// The same, with this amplifier and no other effect.
inline std::vector<Run> runs_of_axis(const strange::Amplifier& amplifier, std::uint64_t seed) {
  return inaccurate_runs_of(strange::Axis{.amplifier = amplifier}, seed);
}

/// Error of the first drive.
inline DriveError error_in(std::vector<Run> measured, const configuration::Rig& rig) {
  Runs runs;
  for (Run& run : measured) runs.push_back(prepare(std::move(run), rig, kUsualAccuracy));
  const Runs none;
  const Study study(rig, runs, none, {}, kUsualAccuracy);
  const WhitenedData data(study, learnt_base_model(study).calibrated);
  return drive_errors(data, data.with({}), rig, kUsualAccuracy).at(0);
}

}  // namespace crane::diagnosis
