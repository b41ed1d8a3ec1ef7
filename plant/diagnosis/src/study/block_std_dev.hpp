#pragma once
/// Standard deviations and penalty of a fit, from the scatter of the scores between blocks.
#include "study/whitened_data.hpp"

namespace crane::diagnosis {

/// Sets Fitted::block_std_dev, left_out and parameters, marginal over inaccuracies that were fitted jointly.
/// @param along whitened slopes, of the effects first
void set_block_std_dev(const WhitenedData& data, const Slopes& along, const Effects& inaccuracies,
                       Fitted& fitted);

}  // namespace crane::diagnosis
