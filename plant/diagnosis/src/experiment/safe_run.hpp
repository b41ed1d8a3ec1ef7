#pragma once
/// A motion of the menu as a crane would do it: synthetic data without noise.
#include <optional>

#include "crane/diagnosis/replay.hpp"
#include "experiment/motion_menu.hpp"

namespace crane::diagnosis {

/// The crane follows the motion under a simple position loop; the commands of that are replayed, so that
/// whoever replays them with the same crane meets the same numbers.
/// @return nothing when the crane leaves the limits of the rig's drives or swing
[[nodiscard]] std::optional<PreparedRun> safe_run(const configuration::Rig& rig, const Crane& crane,
                                                  const SafeMotion& motion);

}  // namespace crane::diagnosis
