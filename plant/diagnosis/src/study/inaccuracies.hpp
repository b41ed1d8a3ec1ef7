#pragma once
/// Quantities of the rig file that are known to a stated accuracy only. They are free within this accuracy in
/// every hypothesis, as nuisance parameters (docs/diagnosis_method.md, 5): an error of a few percent is not a
/// cause and does not hide one.
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/diagnosis/accuracy.hpp"
#include "crane/diagnosis/candidate.hpp"

namespace crane::diagnosis {

/// Largest inaccuracy of each parameter of a cause, in the parameters' units; empty if the accuracy of the
/// rig file does not concern the cause.
/// @param axis of the cause
[[nodiscard]] std::vector<double> largest_inaccuracy(const std::string& cause, const std::string& axis,
                                                     const configuration::Rig& rig, const Accuracy& accuracy);

/// Candidates bounded by the accuracy of the rig file: gain, friction by direction and delay of each drive,
/// length of the cable, mass of the load, and, if both drives of a tower are commanded, inertia of the jib.
/// Scales, lags, and the delay and averaging of the swing are not free; the verdict compares them with their
/// accuracy (verdict/stated_accuracy.hpp).
[[nodiscard]] std::vector<Candidate> inaccuracies_of(std::vector<Candidate> candidates,
                                                     const configuration::Rig& rig, const Accuracy& accuracy);

}  // namespace crane::diagnosis
