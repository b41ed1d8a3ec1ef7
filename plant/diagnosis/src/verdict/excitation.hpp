#pragma once
/// Whether there is enough in the data to say anything.
#include "crane/diagnosis/diagnosis.hpp"
#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {

[[nodiscard]] Runs prepared(std::vector<Run> runs, const configuration::Rig& rig);

/// A drive that no training run moves says nothing of its friction, motor or command: it creeps by less than
/// a friction law is good for. It is taken to be where it was measured.
void hold_resting_drives(Runs& train, Runs& test);

/// @throws DataError when runs differ in what they measure, are too short, or nothing moves
void require_excitation(const Runs& train, const Runs& test, const configuration::Rig& rig);

}  // namespace crane::diagnosis
