#pragma once
/// Paths of moves around the no-go zones of the rig file (docs/zones.md).
#include "crane/configuration/rig.hpp"
#include "crane/control/path.hpp"

namespace crane::services {

/// Speed of a motion on a straight path.
enum class StraightSpeed {
  reference,  ///< a profile of the reference, within the limits of the search
  full,       ///< a step response or a time-optimal plan: only max_speed limits it
};

class ZonePaths {
 public:
  explicit ZonePaths(const configuration::Rig& rig);

  [[nodiscard]] const control::PathSpace& space() const noexcept { return space_; }
  /// False: the rig has no zones, and every path is straight.
  [[nodiscard]] bool needed() const noexcept { return !space_.zones.empty(); }
  /// Path of a move. A straight path that is free only at the speed of the reference is a path by one
  /// waypoint, the target, if the motion could be faster.
  [[nodiscard]] control::Path path(const plant::PerAxis& from, const plant::PerAxis& target,
                                   StraightSpeed speed) const;

 private:
  /// True when the straight path is free at max_speed.
  [[nodiscard]] bool is_free_at_full_speed(const plant::PerAxis& from, const plant::PerAxis& to) const;

  control::PathSpace space_;
  plant::PerAxis max_speed_{};  ///< of the present axes, unit/s
};

}  // namespace crane::services
