#pragma once
/// Least squares over the training data in the noise of one hypothesis.
#include "study/descent.hpp"

namespace crane::diagnosis {

/// Values from which the effects are fitted: of one effect with a rough loss, those of a pattern search;
/// otherwise the given values. @param near  evaluation of some of the effects
[[nodiscard]] Effects initial_values(const WhitenedData& data, const Effects& effects,
                                     const Evaluation& near);

/// Fits the effects from the given values, within their bounds.
/// @param loss_to_beat  training loss; the fit stops early when it cannot fall below
/// @param near  evaluation of some of the effects; gives the initial starts of the windows
/// @param along  in: plain slopes of the effects at their values, or empty; out: plain slopes of the result
[[nodiscard]] Fitted fit(const WhitenedData& data, Effects effects, double loss_to_beat,
                         const Evaluation& near, Slopes& along);
[[nodiscard]] Fitted fit(const WhitenedData& data, Effects effects, double loss_to_beat,
                         const Evaluation& near);

/// Continues the fit until a round gains less than kLeastGainOfVerdict.
[[nodiscard]] Fitted converged(const WhitenedData& data, Fitted fitted);

}  // namespace crane::diagnosis
