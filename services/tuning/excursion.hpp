#pragma once
/// Predicts the largest excursion of a motion before the crane executes it: simulates axis and load
/// on a grid over the ranges of the values that are still possible.
///
/// The load moves relative to the ground at small angles; for slew this contains centrifugal and Coriolis
/// terms. x is the axis, s(x) the suspension point, p the load, phi the swing along the axis:
///   p'' = g (s - p) / L
///   x'' = K_m (V(t - tau) - F sgn x') - r g phi
///   V   = k (R - x + 2 (R' - x') / w), |V| <= volt_limit_v, w = kLoop_radps, k = stiffness_vpu()
/// F is the Coulomb friction in V, R the reference, tau the delay. r is the reaction of the load less the
/// part that the tracking law compensates, (3.37), (3.38) of H. M. Omar, Control of Gantry and Tower Cranes.
#include <cstddef>

#include "crane/experiment/scenario.hpp"
#include "tuning/priors.hpp"

namespace crane::tuning {

/// Ranges of cable length and friction that are possible before a motion.
struct Possible {
  double cable_low_m = 0, cable_high_m = 0;
  double friction_low_v = 0, friction_high_v = 0;  ///< F of the axis: friction without its compensation
};
/// Before the first motion: the ranges of the priors, the cable within the limits of the hoist.
[[nodiscard]] Possible possible_from(const configuration::Rig& rig, const Priors& priors, std::size_t axis);

struct Excursion {
  double swing_rad = 0;  ///< largest swing
  double distance = 0;   ///< largest distance from the mean position of the reference, m or rad
  double speed = 0;      ///< largest speed, m/s or rad/s
};
/// @param scenario  excitations of one axis
[[nodiscard]] Excursion largest_excursion(const configuration::Rig& careful, const Priors& priors,
                                          const Possible& possible, const experiment::Scenario& scenario);

/// Used share of travel, speed and swing limit. Chosen: the reserve covers effects outside the model of
/// largest_excursion(): viscous friction, measurement filters, large angles. Measured: no motion of 60 hidden
/// rigs exceeds 0.97 of the predicted swing and distance (Long.MotionsOfHiddenRigsStayWithinThePrediction).
inline constexpr double kUsedShare = 0.8;

/// @return true when the motion stays within kUsedShare of the limits of the rig on every possible crane
[[nodiscard]] bool is_safe(const configuration::Rig& careful, const Priors& priors, const Possible& possible,
                           const experiment::Scenario& scenario);

}  // namespace crane::tuning
