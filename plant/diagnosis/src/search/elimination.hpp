#pragma once
/// Backward elimination of causes that are not significant by themselves.
#include <cstdint>

#include "search/search.hpp"

namespace crane::diagnosis {

/// Replaces the best hypothesis by the one without its least certain effect, while it has several effects and
/// the Wald test of this effect is insignificant. The likelihood ratio that accepted an effect regards blocks
/// as independent, whereas the standard deviation contains the correlation of neighbouring blocks: a slow
/// disturbance is otherwise named as a small force.
/// @param study whitened with the noise of found.best, before and after the call
/// @return found.best with intervals
[[nodiscard]] Fitted without_insignificant(Study& study, Hypotheses& found, std::uint64_t seed);

}  // namespace crane::diagnosis
