#pragma once
/// The gain on runs that took no part in the fit.
#include "crane/diagnosis/diagnosis.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {

[[nodiscard]] HeldOut held_out(const Study& study, const Effects& effects, std::uint64_t seed);

/// The held-out runs, each as a whole, in structured replays: drives from command and measured swing, load
/// from measured motion, each from the start that suits it best.
[[nodiscard]] std::vector<Trace> traces(const Study& study, const Effects& effects);

}  // namespace crane::diagnosis
