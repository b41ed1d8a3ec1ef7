#pragma once
/// Which motion tells two causes apart that the data cannot.
#include <array>
#include <optional>
#include <vector>

#include "crane/diagnosis/candidate.hpp"
#include "crane/diagnosis/diagnosis.hpp"

namespace crane::diagnosis {

/// Standard deviation of what each output's encoder adds by counting: step / sqrt(12), m or rad; 0 without
/// one.
[[nodiscard]] std::array<double, kOutputs> counting_noise(const runtime::Rig& rig);

/// T-optimality (A. C. Atkinson, V. V. Fedorov, Biometrika 62 (1975) 57): of a menu of motions inside the
/// rig's limits the one in which one cause, refitted, comes least near to what the other one gives; each of
/// the two takes the part of the truth once.
/// @param values_a,values_b as fitted to the data there is
/// @param noise standard deviation per output, m or rad, > 0 where the rig has a sensor: of what a good model
/// leaves
/// @return nothing when no motion separates them by a third of the noise
[[nodiscard]] std::optional<NextExperiment> propose_experiment(const runtime::Rig& rig, const Candidate& a,
                                                               const std::vector<double>& values_a,
                                                               const Candidate& b,
                                                               const std::vector<double>& values_b,
                                                               const std::array<double, kOutputs>& noise);
/// With the counting noise alone, which prefers the finest encoder.
[[nodiscard]] std::optional<NextExperiment> propose_experiment(const runtime::Rig& rig, const Candidate& a,
                                                               const std::vector<double>& values_a,
                                                               const Candidate& b,
                                                               const std::vector<double>& values_b);

}  // namespace crane::diagnosis
