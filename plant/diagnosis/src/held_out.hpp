#pragma once
/// The gain on runs that took no part in the fit.
#include "crane/diagnosis/diagnosis.hpp"
#include "study.hpp"

namespace crane::diagnosis {

[[nodiscard]] HeldOut held_out(const Study& study, const Runs& test, const Effects& effects,
                               std::uint64_t seed);

/// Whole runs in structured replays: drives from command and measured swing, load from measured motion.
[[nodiscard]] std::vector<Trace> traces(const Runs& runs, const Crane& base, const Crane& extended);

}  // namespace crane::diagnosis
