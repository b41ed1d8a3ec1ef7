#pragma once
/// Checks whether the data suffice for a diagnosis.
#include "crane/diagnosis/diagnosis.hpp"
#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {

[[nodiscard]] Runs prepared(std::vector<Run> runs, const configuration::Rig& rig, const Accuracy& accuracy);

/// Prescribes the measured motion of each drive that no training run moves: such a drive has no information
/// about its friction, motor or command, and its creep is smaller than the error of a friction law.
void hold_resting_drives(Runs& train, Runs& test);

/// @throws DataError when runs differ in what they measure, are too short, or nothing moves
void require_excitation(const Runs& train, const Runs& test, const configuration::Rig& rig);

}  // namespace crane::diagnosis
