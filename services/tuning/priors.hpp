#pragma once
/// Knowledge about a rig before its tuning. The rig file states geometry, inertias, drives, encoders and
/// limits. Gains, friction, load, cable length, delay and rest angles of the swing are unknown within these
/// ranges.
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"

namespace crane::tuning {

/// Ranges of the unknown values. Chosen: wider than the errors of a wrong data sheet or another load.
struct Priors {
  double gain_share = 0.4;         ///< |true K_m / K_m of the rig file - 1|
  double friction_share = 0.4;     ///< largest Coulomb friction / volt limit of the drive
  double payload_low = 0.5;        ///< smallest true load mass / load mass of the rig file
  double payload_high = 2;         ///< largest true load mass / load mass of the rig file
  double cable_low_m = 0.4;        ///< shortest true cable length
  double cable_high_m = 2;         ///< longest true cable length
  double delay_periods = 2;        ///< longest delay of a command, in addition to the one tick of the loop
  double rest_angle_rad = 0.0349;  ///< largest measured swing angle of a load at rest, 2 degrees
};

/// Natural frequency of the position loop during the tuning, rad/s, critically damped. Chosen: with the
/// largest gain and delay of the priors the phase margin is 43 degrees: at the crossover 2.06
/// kLoop_radps, tracking PD leads by 76 degrees. Four periods of delay lag by 33 degrees: two of
/// the priors, one tick of the loop, half a period of the zero-order hold and half a period of the
/// speed difference.
inline constexpr double kLoop_radps = 7;

/// The rig file of control loop and bridge during the tuning: tracking PD without swing feedback, with the
/// largest gains, the lightest load and the largest friction of the priors. The loop is therefore
/// never faster than designed, and never overcompensates the force of the load: overcompensation
/// would excite the swing. The friction is not compensated. Checks that need a known model are off
/// (limits.model_checks); all other limits are those of the rig file.
[[nodiscard]] configuration::Rig careful_rig(const configuration::Rig& rig, const Priors& priors);

/// Stiffness of the position loop of careful_rig(), V/m or V/rad.
[[nodiscard]] double stiffness_vpu(const configuration::Rig& careful, std::size_t axis);

/// @return reasons why a rig of this kind cannot be tuned, "file: key: rule"; empty when there are none
[[nodiscard]] std::vector<std::string> problems(const configuration::Rig& rig);

}  // namespace crane::tuning
