#pragma once
/// Standard deviations of the fitted values.
#include "study/whitened_data.hpp"

namespace crane::diagnosis {

/// Sets Fitted::interval_std_dev, marginal over the inaccuracies of the rig file; +-1.96 of them is a 95 %
/// interval. Where an axis sticks and slips, the loss is a stepped function of a value, not a parabola, and
/// the slope at the best value does not give the scatter: the scatter of the minimum of the profile under
/// resampling of the blocks replaces it. If a profile finds a better value, the fit is repeated from this
/// value. @param data in the noise of the fit
[[nodiscard]] Fitted with_intervals(const WhitenedData& data, Fitted fitted, std::uint64_t seed);

}  // namespace crane::diagnosis
