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

struct Descent {
  Loss loss = Loss::robust;
  double loss_to_beat = kNothingToBeat;  ///< the descent ends early when the loss cannot fall below
  /// Number of trailing effects that are inaccuracies of the rig file. Their slopes are used as long as the
  /// simulation is alike (body.hpp). Without inaccuracies, the values of each effect also change alone.
  std::size_t inaccuracies = 0;
  double least_gain = kLeastGain;  ///< a round that decreases the Cauchy loss by less is the last one
};

/// Gauss-Newton rounds from `best`. @param along  plain slopes at `best`, as far as known; on return those of
/// the result, as far as known
/// @return false when the loss cannot fall below `loss_to_beat`
bool descend(const WhitenedData& data, Fitted& best, const Descent& descent, Slopes& along);

}  // namespace crane::diagnosis
