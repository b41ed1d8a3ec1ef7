#pragma once
/// One reader per section of a rig file; each notes its problems in the document (toml_reader.hpp).
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/configuration/toml_reader.hpp"

namespace crane::configuration {

/// Unit suffixes of one axis' coordinate and its derivatives.
struct AxisText {
  std::string_view name;            ///< "trolley"
  std::string_view position;        ///< "trolley_position_m", key in [start]
  std::string_view unit;            ///< "m"
  std::string_view speed;           ///< "mps"
  std::string_view acceleration;    ///< "mps2"
  std::string_view jerk;            ///< "mps3"
  std::string_view volt_per_speed;  ///< "vspm", V per m/s
};
inline constexpr std::array<AxisText, plant::kAxes> kAxisTexts{{
    {"trolley", "trolley_position_m", "m", "mps", "mps2", "mps3", "vspm"},
    {"slew", "slew_angle_rad", "rad", "radps", "radps2", "radps3", "vsprad"},
    {"hoist", "cable_length_m", "m", "mps", "mps2", "mps3", "vspm"},
}};

/// "low_limit" and "m" give "low_limit_m".
[[nodiscard]] inline std::string with_unit(std::string_view quantity, std::string_view unit) {
  return std::string(quantity) + '_' + std::string(unit);
}

inline constexpr int kLastChannel = 7;  ///< boards have 8 counters and 8 analog outputs

/// +1 or -1, +1 when the file does not say.
[[nodiscard]] int read_sign(TomlTable& table);
/// Two drives on one output, or two encoders on one counter, are a wiring mistake.
void check_unique(TomlTable& table, std::string_view key, int channel, std::vector<int>& taken);
/// Replaces the parameters that the table names.
void override_plant(TomlTable& table, plant::Parameters& parameters);

// In the order in which they are called: later sections are checked against the earlier ones.
void read_drives(TomlTable& root, Rig& rig);
void read_encoders(TomlTable& root, Rig& rig);
void read_plant(TomlTable& root, Rig& rig);
void read_terms(TomlTable& root, Rig& rig);
void read_wiring(TomlTable& root, Rig& rig);
void read_homing(TomlTable& root, Rig& rig);
void read_sensing(TomlTable& root, Rig& rig);
void read_limits(TomlTable& root, Rig& rig);
void read_start(TomlTable& root, Rig& rig);
void read_controller(TomlTable& root, Rig& rig);

}  // namespace crane::configuration
