#pragma once
/// Writes the rig of one experiment to a file, for the processes of the experiment and for its repetition.
#include <filesystem>

#include "crane/configuration/rig.hpp"

namespace crane::experiments {

/// Every field of the rig as TOML, below a comment with the origin.
[[nodiscard]] std::string rig_at_start_text(const configuration::Rig& rig_at_start);

/// Writes every field of the rig: a process that reads the file runs the same rig, bit for bit, with every
/// change by a scenario and by variants. @throws files::WriteError
void write_rig_at_start(const std::filesystem::path& file, const configuration::Rig& rig_at_start);

}  // namespace crane::experiments
