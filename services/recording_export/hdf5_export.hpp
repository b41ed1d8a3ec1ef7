#pragma once
/// Writes recordings as HDF5.
#include <filesystem>
#include <string>

#include "crane/recording/mcap_reader.hpp"

namespace crane::recording_export {

/// Writes one group per topic ("/crane/state") with one dataset per field, and the metadata as attributes of
/// the root. The file appears, or replaces an existing file, only when it is complete.
/// @param topic  full name; empty: all topics that can be decoded
/// @throws std::runtime_error when the file cannot be written; DecodeError, SchemaError
void write_hdf5(const std::filesystem::path& file, recording::McapReader& recording,
                const std::string& topic);

}  // namespace crane::recording_export
