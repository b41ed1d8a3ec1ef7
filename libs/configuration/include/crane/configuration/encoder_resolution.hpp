#pragma once
/// Coarsest encoder of a drive with which supervisor and bridge can check its motion.
#include "crane/configuration/rig.hpp"

namespace crane::configuration {

/// The bridge stops an axis whose speed, the change of the position in one period, exceeds max_speed by this
/// factor. Below max_speed, the supervisor reacts first.
inline constexpr double kBridgeSpeedMargin = 1.1;

/// Counts per m or rad with which neither the slip of a closed brake nor a speed of max_speed is hidden by
/// one count: one count is at most `brake_slip`, and at most the difference of both speed limits times a
/// period.
[[nodiscard]] double least_counts_per_unit(const Drive& drive, double period_s) noexcept;

}  // namespace crane::configuration
