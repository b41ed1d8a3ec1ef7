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

/// The most significant pulse, by the test of a short force (docs/diagnosis_method.md, 9).
/// @param problem of the load, whitened, with windows of several periods
/// @param output index into its outputs @param permitted share of the motion: accuracy of the rig file
[[nodiscard]] std::optional<ShortForce> find_short_force(const Problem& problem, const Fits& fits,
                                                         std::size_t output, double permitted);

}  // namespace crane::diagnosis
