#pragma once
/// The gain on runs that took no part in the fit.
#include "crane/diagnosis/diagnosis.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {

/// @param as_measured study of the same runs before what encoders lost was put back: what the base model is
/// held against; `study` itself where nothing was lost
[[nodiscard]] HeldOut held_out(const Study& study, const Study& as_measured, const Effects& effects,
                               std::uint64_t seed);

/// The held-out runs, each as a whole, in structured replays: drives from command and measured swing, load
/// from measured motion, each from the start that suits it best.
/// @param as_measured as above
[[nodiscard]] std::vector<Trace> traces(const Study& study, const Study& as_measured, const Effects& effects);

}  // namespace crane::diagnosis
