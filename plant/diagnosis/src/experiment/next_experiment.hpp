#pragma once
/// Which motion tells two causes apart that the data cannot.
#include <array>
#include <optional>
#include <vector>

#include "crane/diagnosis/candidate.hpp"
#include "crane/diagnosis/diagnosis.hpp"
#include "noise/whitening.hpp"

namespace crane::diagnosis {

/// Noise and disturbance of each output, as learnt from the data there is.
using Disturbances = std::array<Disturbance, kOutputs>;

/// T-optimality (A. C. Atkinson, V. V. Fedorov, Biometrika 62 (1975) 57): of a menu of motions inside the
/// rig's limits the one in which one cause, refitted, comes least near to what the other one gives; each of
/// the two takes the part of the truth once.
/// @param values_a,values_b as fitted to the data there is
/// @return nothing when no motion separates them by ten standard deviations of the noise
[[nodiscard]] std::optional<NextExperiment> propose_experiment(const runtime::Rig& rig, const Candidate& a,
                                                               const std::vector<double>& values_a,
                                                               const Candidate& b,
                                                               const std::vector<double>& values_b,
                                                               const Disturbances& disturbances);

}  // namespace crane::diagnosis
