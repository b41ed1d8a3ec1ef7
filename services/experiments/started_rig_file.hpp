#pragma once
/// The rig as one experiment runs it, as a file for the processes of the experiment and for a repetition.
#include <filesystem>

#include "crane/runtime/rig.hpp"

namespace crane::experiments {

/// Writes a rig file that extends that of `rig` and reads back as `started`: a scenario (scenario.hpp) and
/// variants (variant.hpp) have been applied to it, nothing else. @throws RunError when it cannot be written
void write_started_rig(const std::filesystem::path& file, const runtime::Rig& rig,
                       const runtime::Rig& started);

}  // namespace crane::experiments
