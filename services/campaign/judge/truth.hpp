#pragma once
/// Whether a limit was really crossed when a reason said so: by the truth, with formulas of the judge's own.
/// A fault may drive a crane beyond any of its limits, so that the reason of the limit that was crossed first
/// is right.
#include <span>

#include "campaign/judge/record.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::campaign {

/// @return true when the truth at row k, or one tick before, is beyond the limit that `reason` names; false
/// for a
///         reason that names none
[[nodiscard]] bool is_true(const Reason& reason, const configuration::Rig& rig, std::span<const Row> rows,
                           std::size_t k);

/// Farthest that an axis with this speed goes until brakes have stopped it, unit. @param reaction_s  until
/// they close
[[nodiscard]] double way_to_a_stop(const configuration::Drive& drive, double speed, double reaction_s);

/// The supervisor's reaction: one tick until a sample shows the speed, a ramp of 20 ms, the brake.
[[nodiscard]] double supervisor_reaction_s(const configuration::Rig& rig, std::size_t axis);

}  // namespace crane::campaign
