#pragma once
/// Motions of the tuning. Every motion is a reference of one axis that the supervisor checks
/// (REQUEST_FOLLOW), and is safe on every crane that is still possible (excursion.hpp).
///   probe  two slow periods of a sine whose amplitude raises the voltage up to a level, then rest
///   main   a sum of two sines below the frequency of the load, then steps in both directions
#include "crane/experiment/scenario.hpp"
#include "tuning/excursion.hpp"

namespace crane::tuning {

/// Voltages of successive probes / voltage limit of the drive. The last voltage exceeds the largest friction
/// of the priors.
inline constexpr std::array kProbeLevels{0.06, 0.12, 0.24, 0.5};
inline constexpr double kMotionBegin_s = 0.5;

/// @param careful   careful_rig()
/// @param possible  cranes that are possible before the probe
[[nodiscard]] experiment::Scenario probe(const configuration::Rig& careful, const Priors& priors,
                                         std::size_t axis, double level, const Possible& possible);

/// Result of the probes of one axis.
struct Rough {
  double cable_m = 1, cable_error_m = 0;  ///< standard error
  double friction_v = 0;                  ///< friction of the axis, mean of both directions
};
/// The rig of the main motion, with compensation of half the rough friction. A larger compensation could move
/// an axis against its reference.
[[nodiscard]] configuration::Rig compensated(configuration::Rig careful, std::size_t axis,
                                             const Rough& rough);
/// Cranes that are possible before the main motion.
[[nodiscard]] Possible possible_from(const Rough& rough);
[[nodiscard]] experiment::Scenario main_motion(const configuration::Rig& careful, const Priors& priors,
                                               std::size_t axis, const Rough& rough);

}  // namespace crane::tuning
