#pragma once
/// Whether there is enough in the data to say anything.
#include "crane/diagnosis/diagnosis.hpp"
#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {

[[nodiscard]] Runs prepared(std::vector<Run> runs, const configuration::Rig& rig);

/// @throws DataError when runs differ in what they measure, are too short, or nothing moves
void require_excitation(const Runs& train, const Runs& test, const configuration::Rig& rig);

}  // namespace crane::diagnosis
