#pragma once
/// Checks with the true state, and with formulas of the judge, whether a limit was crossed. A fault may move
/// a crane beyond any limit; the reason of the limit that was crossed first is then correct.
#include <span>

#include "campaign/judge/record.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::campaign {

/// @return true when the true state at row k, or one tick before, is beyond the limit that `reason` names;
/// false for a reason without a limit
[[nodiscard]] bool is_true(const Reason& reason, const configuration::Rig& rig, std::span<const Row> rows,
                           std::size_t k);

/// Stopping distance from `speed` (m/s or rad/s), m or rad. @param reaction_s  time until the brakes close
[[nodiscard]] double stopping_distance(const configuration::Drive& drive, double speed, double reaction_s);

/// Reaction time of the supervisor: one tick until a sample shows the speed, a ramp of 20 ms, the brake.
[[nodiscard]] double supervisor_reaction_s(const configuration::Rig& rig, std::size_t axis);

}  // namespace crane::campaign
