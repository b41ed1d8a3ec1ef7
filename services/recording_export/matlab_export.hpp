#pragma once
/// Writes recordings as MATLAB MAT-files of level 5, which MATLAB, GNU Octave and SciPy read.
#include <filesystem>
#include <string>

#include "crane/recording/mcap_reader.hpp"

namespace crane::recording_export {

/// Writes one structure per topic ("crane_state") with one member per field, and the structure "recording"
/// with the metadata. The file appears, or replaces an existing file, only when it is complete.
/// @param topic  full name; empty: all topics that can be decoded
/// @throws std::runtime_error when the file cannot be written, or a topic is larger than the format permits;
///   DecodeError, SchemaError
void write_matlab(const std::filesystem::path& file, recording::McapReader& recording,
                  const std::string& topic);

}  // namespace crane::recording_export
