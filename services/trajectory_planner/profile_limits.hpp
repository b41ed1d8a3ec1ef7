#pragma once
/// Steps and speeds of the reference of a straight move that do not endanger the load.
#include <array>

#include "crane/configuration/rig.hpp"
#include "crane/control/law.hpp"

namespace crane::services {

/// Target of a move. The reference of an axis that is not selected does not change.
struct MoveTarget {
  std::array<bool, control::kAxes> selected{};
  std::array<double, control::kAxes> target{};  ///< m, rad, m of cable
};

struct ProfileLimits {
  bool steps = false;           ///< true: the references of trolley and slew step to their targets
  double slew_speed_radps = 0;  ///< largest speed of the profile of the slew axis
};

/// A reference steps if the law uses steps, the step is not larger than those for which these laws were
/// designed, and a jib does not turn while the trolley is near its high limit. Otherwise every axis follows a
/// profile. A jib that turns with the angular speed w swings the load outwards by w^2 x / g; the laws move
/// the trolley outwards to reduce this swing. The profile of the slew axis is therefore slower for these
/// laws, and near the high limit of the trolley for all laws. The lengths are those of a laboratory's crane
/// with a jib of 1 to 3 m. Routes around zones, time-optimal plans and the stick have limits of their own.
/// @param now  reference at the start of the move
[[nodiscard]] ProfileLimits profile_limits(const configuration::Rig& rig, control::ReferenceShape shape,
                                           const control::Reference& now, const MoveTarget& move) noexcept;

}  // namespace crane::services
