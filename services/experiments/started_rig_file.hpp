#pragma once
/// The rig as one experiment runs it, as a file for the processes of the experiment and for a repetition.
#include <filesystem>

#include "crane/configuration/rig.hpp"

namespace crane::experiments {

/// Writes a rig file that extends that of `rig` and reads back as `started`: a scenario (scenario.hpp) and
/// variants (variant.hpp) have been applied to it, nothing else. @throws RunError when it cannot be written
void write_started_rig(const std::filesystem::path& file, const configuration::Rig& rig,
                       const configuration::Rig& started);

}  // namespace crane::experiments
