#pragma once
/// Identifies cable length, rest angles, load mass, and gain, friction and delay of each drive from the
/// motions of the tuning. The swing depends on the measured motion of its support only, so that cable length
/// and rest angles are fitted first (Part::load), and then the second mode of a load below a hook, if any.
/// The motion of a drive depends on its voltage and on the measured swing (Part::drive); the force of the
/// load on the trolley gives the load mass.
#include "crane/recording/csv.hpp"
#include "tuning/identified.hpp"
#include "tuning/motion.hpp"
#include "tuning/priors.hpp"
#include "tuning/windowed_fit.hpp"

namespace crane::tuning {

/// A motion as the simulations of plant/diagnosis read it. @throws identification::IdentificationError when a
/// column or a tick is missing
[[nodiscard]] diagnosis::PreparedRun prepared(const recording::Table& table, const configuration::Rig& rig);

/// The crane of the rig file without the terms that the tuning identifies, with a true cable length and rest
/// angles.
[[nodiscard]] diagnosis::Crane crane_with(const configuration::Rig& rig, double cable_m,
                                          std::array<double, 2> rest_angle_rad);
/// Fit of the swing, without a crane.
[[nodiscard]] WindowedFit load_fit(bool tower);

struct LoadFit {
  Value cable_m;
  std::array<Value, 2> rest_angle_rad;
  double residual_rms = 0;  ///< rad
};
/// @throws identification::IdentificationError
[[nodiscard]] LoadFit fit_load(const std::vector<diagnosis::PreparedRun>& runs, const configuration::Rig& rig,
                               const Priors& priors);

/// Main motion of each drive. @throws identification::IdentificationError
struct MainMotions {
  std::array<std::optional<recording::Table>, 2> of_axis;
};
struct Identification {
  Identified values;
  double swing_residual_rad = 0;           ///< rms
  std::array<double, 2> drive_residual{};  ///< rms, m or rad
};
[[nodiscard]] Identification identify(const MainMotions& motions, const configuration::Rig& rig,
                                      const Priors& priors);

}  // namespace crane::tuning
