#pragma once
/// Force that acts on the load for a short time: a push by hand, a gust, a collision. The noise model
/// describes such a force as a stronger random force, which would act all the time.
#include <optional>

#include "shooting/problem.hpp"

namespace crane::diagnosis {

/// A pulse of force in the direction of one swing.
struct ShortForce {
  Output output = kRadialSwing;
  std::size_t run = 0;
  double from_s = 0, duration_s = 0;  ///< time in the run
  double share_of_weight = 0;         ///< peak, with its sign
};

/// The most significant pulse. Each pulse is fitted alone to the whitened residual; t is its amplitude over
/// the standard deviation by the noise model. The standard uncertainty of t consists of
/// - noise and disturbance: 1.4826 times the median of |t| over all pulses of the same duration. A few forces
///   do not change the median
///   (docs/diagnosis.md, 9). For pulses during a motion of the support, the median over these pulses, if it
///   is larger: the measured motion of the support has an error;
/// - the permitted share of the swing, in all directions, around the pulse.
/// Level kSignificant for a normal error, Bonferroni over the pulses and the outputs.
/// @param problem of the load, whitened, with windows of several periods
/// @param output index into its outputs @param permitted share of the motion: accuracy of the rig file
[[nodiscard]] std::optional<ShortForce> find_short_force(const Problem& problem, const Fits& fits,
                                                         std::size_t output, double permitted);

}  // namespace crane::diagnosis
