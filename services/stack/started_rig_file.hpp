#pragma once
/// Writes the rig of one experiment to a file, for the processes of the experiment and for its repetition.
#include <filesystem>

#include "crane/runtime/rig.hpp"

namespace crane::stack {

/// Writes a rig file that extends that of `rig` and reads back as `started`. @param started  `rig` changed by
/// a scenario (scenario.hpp) and by variants (variant.hpp) only. @throws RunError when the file cannot be
/// written
void write_started_rig(const std::filesystem::path& file, const runtime::Rig& rig,
                       const runtime::Rig& started);

}  // namespace crane::stack
