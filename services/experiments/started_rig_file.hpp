#pragma once
/// The rig as one experiment runs it, as a file for the processes of the experiment and for a repetition.
#include <filesystem>

#include "crane/configuration/rig.hpp"

namespace crane::experiments {

/// Writes every field of the rig: processes that read the file run the same rig, bit for bit, whatever a
/// scenario and variants have changed. @throws RunError when it cannot be written
void write_started_rig(const std::filesystem::path& file, const configuration::Rig& started);

}  // namespace crane::experiments
