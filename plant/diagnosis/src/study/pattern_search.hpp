#pragma once
/// Pattern search on a rough loss (R. Hooke, T. A. Jeeves, J. ACM 8 (1961) 212).
#include "study/whitened_data.hpp"

namespace crane::diagnosis {

/// Pattern search with decreasing steps from `best`. @param loss  the loss that decreases
/// @param hold_bounds  parameters that are usually at a bound stay
void step_around(const WhitenedData& data, Fitted& best, double Evaluation::*loss, bool hold_bounds);

/// Initial values of one effect with a rough loss: the best of its rough_starts and of a pattern search by
/// the loss of the load; from there a pattern search by the whole loss, with each parameter that is usually
/// at a bound held at both. @param near  evaluation of some of the effects
[[nodiscard]] Effects search_around(const WhitenedData& data, const Effects& effects, const Evaluation& near);

}  // namespace crane::diagnosis
