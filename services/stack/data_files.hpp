#pragma once
/// Finds rig, scenario and sweep files by name: "maneuver_1" is deploy/scenarios/maneuver_1.toml of this
/// installation.
#include <array>
#include <filesystem>
#include <string>

namespace crane::stack {

/// Default rig of every command.
inline constexpr const char* kDefaultRig = "virginia_tech_tower";
/// Scenarios of `crane demo` and `crane run --compare`.
inline constexpr std::array kManeuvers{"maneuver_1", "maneuver_2", "maneuver_3"};

/// @return the file itself, or the installed file with this name. @throws configuration::ConfigurationError
///   with the list of installed names
[[nodiscard]] std::filesystem::path find_rig(const std::string& name_or_path);
[[nodiscard]] std::filesystem::path find_scenario(const std::string& name_or_path);
[[nodiscard]] std::filesystem::path find_sweep(const std::string& name_or_path);

}  // namespace crane::stack
