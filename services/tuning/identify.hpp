#pragma once
/// Identifies cable length, rest angles, load mass, and gain, friction and delay of each drive from the
/// motions of the tuning. First fits cable length and rest angles, because the swing depends only on the
/// measured motion of the support (Part::load); then the second mode of a load below a hook, if any; then
/// each drive, whose motion depends on its voltage and on the measured swing (Part::drive). The force of the
/// load on the trolley determines the load mass.
#include "crane/recording/csv.hpp"
#include "tuning/identified.hpp"
#include "tuning/motion.hpp"
#include "tuning/priors.hpp"
#include "tuning/windowed_fit.hpp"

namespace crane::tuning {

/// @throws identification::IdentificationError when a tick of the motion is missing
void require_every_tick(const recording::Table& table);
/// Converts a motion to the input of the simulations of plant/diagnosis. @throws
/// identification::IdentificationError when a column or a tick is missing
[[nodiscard]] diagnosis::PreparedRun prepared(const recording::Table& table, const configuration::Rig& rig);

/// The crane of the rig file with this true cable length and these rest angles, without the terms that the
/// tuning identifies.
[[nodiscard]] diagnosis::Crane crane_with(const configuration::Rig& rig, double cable_m,
                                          std::array<double, 2> rest_angle_rad);
/// Settings of the fit of the swing; the caller sets WindowedFit::crane.
[[nodiscard]] WindowedFit load_fit(bool tower);

struct LoadFit {
  Value cable_m;
  std::array<Value, 2> rest_angle_rad;
  double residual_rms = 0;  ///< rad
};
/// @throws identification::IdentificationError
[[nodiscard]] LoadFit fit_load(const std::vector<diagnosis::PreparedRun>& runs, const configuration::Rig& rig,
                               const Priors& priors);

/// Main motion of each drive.
struct MainMotions {
  std::array<std::optional<recording::Table>, 2> of_axis;  ///< trolley, slew; nothing: no such drive
};
struct Identification {
  Identified values;
  double swing_residual_rad = 0;           ///< rms
  std::array<double, 2> drive_residual{};  ///< rms, m or rad
};
/// @throws identification::IdentificationError
[[nodiscard]] Identification identify(const MainMotions& motions, const configuration::Rig& rig,
                                      const Priors& priors);

}  // namespace crane::tuning
