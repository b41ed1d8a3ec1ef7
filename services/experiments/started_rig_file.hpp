#pragma once
/// Writes the rig of one experiment to a file, for the processes of the experiment and for its repetition.
#include <filesystem>

#include "crane/configuration/rig.hpp"

namespace crane::experiments {

/// Writes a rig file that extends that of `rig` and reads back as `started`. @param started  `rig` changed by
/// a scenario (scenario.hpp) and by variants (variant.hpp) only. @throws RunError when the file cannot be
/// written
void write_started_rig(const std::filesystem::path& file, const configuration::Rig& rig,
                       const configuration::Rig& started);

}  // namespace crane::experiments
