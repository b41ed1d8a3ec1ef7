#pragma once
/// Least squares over the training data in the noise of one hypothesis.
#include <cstddef>
#include <limits>

#include "study/whitened_data.hpp"

namespace crane::diagnosis {

/// A fit never ends early for a loss to beat.
inline constexpr double kNothingToBeat = std::numeric_limits<double>::infinity();
/// A round that decreases the Cauchy loss by less is the last one.
inline constexpr double kLeastGain = 0.3;

/// Values from which the effects are fitted. A pattern search finds those of one effect with a rough loss;
/// others are unchanged. @param near  evaluation of some of the effects
[[nodiscard]] Effects initial_values(const WhitenedData& data, const Effects& effects,
                                     const Evaluation& near);

/// Fits the effects from the given values, within their bounds.
/// @param loss_to_beat  training loss; the fit stops early when it cannot fall below
/// @param near  evaluation of some of the effects; gives the initial starts of the windows
/// @param along  plain slopes of the effects, at their values, or empty; those of the result on return
[[nodiscard]] Fitted fit(const WhitenedData& data, Effects effects, double loss_to_beat,
                         const Evaluation& near, Slopes& along);
[[nodiscard]] Fitted fit(const WhitenedData& data, Effects effects, double loss_to_beat,
                         const Evaluation& near);

/// The fit at the minimum of the loss near its values.
[[nodiscard]] Fitted converged(const WhitenedData& data, Fitted fitted);

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
