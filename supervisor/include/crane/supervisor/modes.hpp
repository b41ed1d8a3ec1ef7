#pragma once
/// Operating modes: which requests may move the crane, and how fast. Names and numbers are those of
/// idl/crane.idl. docs/safety.md contains the table of the modes.
#include <optional>
#include <string>
#include <string_view>

#include "crane/supervisor/states.hpp"

namespace crane::supervisor {

enum class Mode : std::uint8_t { semi_automatic, automatic, manual, maintenance };
inline constexpr std::size_t kModes = 4;

/// Moves that a mode permits.
enum class Moves : std::uint8_t {
  none,
  short_steps,  ///< at most kShortStep_m per axis
  all
};

/// Longest move of Moves::short_steps, m: an inching step of up to 20 mm plus a position error of 10 mm.
/// Slew axis: m of arc at the present radius of the trolley, at least kShortestRadius_m.
inline constexpr double kShortStep_m = 0.03;
/// At radius 0, a step of the slew axis would have no finite angle.
inline constexpr double kShortestRadius_m = 0.1;

struct ModeRule {
  const char* name;     ///< name in the command line, for example "semi_automatic"
  bool stick;           ///< true: REQUEST_JOG is permitted
  Moves moves;          ///< REQUEST_MOVE
  bool excitation;      ///< true: REQUEST_FOLLOW is permitted
  double stick_share;   ///< largest deflection that acts, (0, 1]
  double speed_share;   ///< share of max_speed above which OVERSPEED stops the crane, (0, 1]
  const char* purpose;  ///< in a few words, for status and documents
};

[[nodiscard]] const ModeRule& rule_of(Mode mode) noexcept;
[[nodiscard]] inline const char* name_of(Mode mode) noexcept { return rule_of(mode).name; }
/// @return nothing when no mode has this name
[[nodiscard]] std::optional<Mode> find_mode(std::string_view name) noexcept;
/// "semi_automatic, automatic, manual or maintenance"
[[nodiscard]] std::string mode_names();
/// The deflection that acts in this mode.
[[nodiscard]] PerAxis limited_stick(Mode mode, const PerAxis& deflection) noexcept;
/// Table of docs/safety.md in Markdown.
[[nodiscard]] std::string mode_table();

}  // namespace crane::supervisor
