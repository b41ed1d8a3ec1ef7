#pragma once
/// Rig and scenario files by name: "maneuver_1" is deploy/scenarios/maneuver_1.toml of this installation.
#include <filesystem>
#include <string>

namespace crane::stack {

/// A file as given, or the one of that name that comes with the project. @throws
/// configuration::ConfigurationError listing the names there are
[[nodiscard]] std::filesystem::path find_rig(const std::string& name_or_path);
[[nodiscard]] std::filesystem::path find_scenario(const std::string& name_or_path);

}  // namespace crane::stack
