#pragma once
/// How well the data know the values of a fit.
#include "study/study.hpp"

namespace crane::diagnosis {

/// A fit with standard deviations that are those of resampled data. Where an axis sticks and slips the loss
/// goes over a value in steps, not in a parabola; its slope at the best value says little about how far
/// another body of data would move it. Begins anew from a value that turns out to be better.
[[nodiscard]] Fitted with_intervals(const Study& study, Fitted fitted, std::uint64_t seed);

}  // namespace crane::diagnosis
