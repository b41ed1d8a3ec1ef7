#pragma once
/// Damped Gauss-Newton descent of the loss over the training data.
#include <cstddef>
#include <limits>

#include "study/whitened_data.hpp"

namespace crane::diagnosis {

/// A descent never ends early for a loss to beat.
inline constexpr double kNothingToBeat = std::numeric_limits<double>::infinity();
/// A round that decreases the Cauchy loss by less is the last one.
inline constexpr double kLeastGain = 0.3;

/// What a descent minimises, and when it ends.
struct Descent {
  Loss loss = Loss::robust;
  double loss_to_beat = kNothingToBeat;  ///< the descent ends early when the loss cannot fall below
  /// Number of trailing effects that are inaccuracies of the rig file. The slopes along them are used until
  /// the simulation is unlike the one at which they were computed (unlike(), body.hpp); a descent whose steps
  /// had other effects than predicted ends only with new ones. Without inaccuracies, the values of each
  /// effect also change alone.
  std::size_t inaccuracies = 0;
  double least_gain = kLeastGain;  ///< a round that decreases the Cauchy loss by less is the last one
};

/// Gauss-Newton rounds from `best`. @param along  plain slopes near `best`, as far as known; on return those
/// near the result
/// @return false when the loss cannot fall below `loss_to_beat`
bool descend(const WhitenedData& data, Fitted& best, const Descent& descent, FitSlopes& along);

}  // namespace crane::diagnosis
