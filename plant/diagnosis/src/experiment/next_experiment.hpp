#pragma once
/// The motion that separates two hypotheses best.
#include <array>
#include <optional>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"
#include "noise/whitening.hpp"
#include "study/whitened_data.hpp"

namespace crane::diagnosis {

/// Disturbance of each output, as learnt from the data.
using Disturbances = std::array<Disturbance, kOutputs>;

/// Disturbances of the simulated outputs. An output without a measurement gets a noise of 1e6 m or rad,
/// so that it has no weight.
[[nodiscard]] Disturbances disturbances_of(const WhitenedData& data);

/// T-optimality (A. C. Atkinson, V. V. Fedorov, Biometrika 62 (1975) 57): selects the listed motion for
/// which the refitted rival differs most from the predictions of the assumed truth. Each hypothesis is the
/// truth in turn; the smaller separation counts.
/// @param a,b hypotheses with fitted values; common causes are fixed
/// @return nothing if no motion separates them by ten standard deviations of the noise
[[nodiscard]] std::optional<NextExperiment> propose_experiment(const configuration::Rig& rig,
                                                               const Effects& a, const Effects& b,
                                                               const Disturbances& disturbances);

}  // namespace crane::diagnosis
