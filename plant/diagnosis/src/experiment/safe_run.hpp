#pragma once
/// Simulated data of a motion of the menu, without noise.
#include <optional>

#include "crane/diagnosis/replay.hpp"
#include "experiment/motion_menu.hpp"

namespace crane::diagnosis {

/// The crane follows the motion under a position loop. The measurement is a simulation with its commands, so
/// that a simulation of the same crane has no residual.
/// @return nothing if the crane leaves the limits of travel or swing
[[nodiscard]] std::optional<PreparedRun> safe_run(const configuration::Rig& rig, const Crane& crane,
                                                  const SafeMotion& motion);

}  // namespace crane::diagnosis
