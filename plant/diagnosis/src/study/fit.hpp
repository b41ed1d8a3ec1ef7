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

/// Gauss-Newton rounds from `best`. @param along  plain slopes at `best` of its leading values, as far as
/// known; those of the result on return, all or none
/// @param apart  number of leading effects whose values also change alone
/// @param least_gain  a round that decreases the Cauchy loss by less is the last one
/// @return false when the loss cannot fall below `loss_to_beat`
bool descend(const WhitenedData& data, Fitted& best, Loss loss, double loss_to_beat, Slopes& along,
             std::size_t apart, double least_gain = kLeastGain);

}  // namespace crane::diagnosis
