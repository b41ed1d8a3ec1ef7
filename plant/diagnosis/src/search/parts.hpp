#pragma once
/// The parts of a hypothesis: the hypotheses that lack one of its effects.
#include <cstddef>
#include <vector>

#include "study/own_noise.hpp"

namespace crane::diagnosis {

/// The effects other than effect `i`. @pre i < effects.size()
[[nodiscard]] Effects without(const Effects& effects, std::size_t i);

/// The fit of these effects, or nullptr. `all` holds each set of effects once at most.
[[nodiscard]] const Fitted* find(const std::vector<Fitted>& all, const Effects& effects);

/// Adds a fit to `all`; of two fits of the same effects, the likelier one remains.
void keep(std::vector<Fitted>& all, const Fitted& fitted);

/// At the values of a part, with amount 0 of the remaining effect, a hypothesis is as likely as the part. A
/// less likely fit has stopped at another minimum; it is repeated from the values of the part.
/// @param all fits among which the parts are looked up @return the likeliest of `given` and the repeated fits
[[nodiscard]] Fitted no_worse_than_its_parts(const Study& study, const BaseModel& base,
                                             const std::vector<Fitted>& all, const Fitted& given);

/// The hypotheses of both lists, each once, in the order of decreasing likelihood.
[[nodiscard]] std::vector<Fitted> merged(std::vector<Fitted> some, const std::vector<Fitted>& more);

}  // namespace crane::diagnosis
