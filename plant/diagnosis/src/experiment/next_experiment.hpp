#pragma once
/// Which motion tells two hypotheses apart that the data cannot.
#include <array>
#include <optional>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"
#include "noise/whitening.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {

/// Noise and disturbance of each output, as learnt from the data there is.
using Disturbances = std::array<Disturbance, kOutputs>;

/// Of the replays; an output that is not measured has so much noise that it tells nothing.
[[nodiscard]] Disturbances disturbances_of(const Study& study);

/// T-optimality (A. C. Atkinson, V. V. Fedorov, Biometrika 62 (1975) 57): of a menu of motions inside the
/// rig's limits the one in which one hypothesis, refitted, comes least near to what the other one gives; each
/// of the two takes the part of the truth once.
/// @param a,b with their values as fitted to the data there is; what both have need not be told apart
/// @return nothing when no motion separates them by ten standard deviations of the noise
[[nodiscard]] std::optional<NextExperiment> propose_experiment(const configuration::Rig& rig,
                                                               const Effects& a, const Effects& b,
                                                               const Disturbances& disturbances);

}  // namespace crane::diagnosis
