#pragma once
/// Finds rig, scenario and sweep files by name: "maneuver_1" is deploy/scenarios/maneuver_1.toml of this
/// installation.
#include <filesystem>
#include <string>

namespace crane::stack {

/// @return the file itself, or the installed file with this name. @throws configuration::ConfigurationError
/// with
///   the list of installed names
[[nodiscard]] std::filesystem::path find_rig(const std::string& name_or_path);
[[nodiscard]] std::filesystem::path find_scenario(const std::string& name_or_path);
[[nodiscard]] std::filesystem::path find_sweep(const std::string& name_or_path);

}  // namespace crane::stack
