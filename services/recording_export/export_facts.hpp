#pragma once
/// Functions that the exports to HDF5 and MATLAB share.
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "crane/recording/columns.hpp"

namespace crane::recording_export {

/// Description of a recording for the exported file: "exported_by", "recording", "messages_version", the
/// entries of the metadata ("crane.domain") and the texts of the attachments ("rig.toml").
[[nodiscard]] std::map<std::string, std::string> export_facts(recording::McapReader& recording);

/// @return unit of all elements of the column; "": dimensionless; nothing: the elements have different units
[[nodiscard]] std::optional<std::string> common_unit(const recording::Column& column);

/// Calls `write` with the name of a new file beside FILE and renames the result to FILE. When `write` throws,
/// no file remains. @throws std::runtime_error that names FILE, also as CompleteFile; DecodeError,
/// SchemaError of the recording unchanged
void write_completely(const std::filesystem::path& file, const recording::McapReader& recording,
                      const std::function<void(const std::string& partial)>& write);

}  // namespace crane::recording_export
