#pragma once
/// Coarsest encoders with which supervisor and bridge can check the speed of a drive.
#include "crane/configuration/rig.hpp"

namespace crane::configuration {

/// The bridge stops an axis whose speed, the change of the position in one period, exceeds max_speed by this
/// factor. Below max_speed, the supervisor reacts first.
inline constexpr double kBridgeSpeedMargin = 1.1;

/// Counts per m or rad with which one count hides neither the slip of a closed brake nor a speed between the
/// limits of supervisor and bridge.
[[nodiscard]] double least_counts_per_unit(const Drive& drive, double period_s) noexcept;

/// Call before a control loop runs the rig. A rig file that only describes measured data may have coarser
/// sensors.
/// @throws ConfigurationError with file, key, value and rule of each drive with fewer counts
void require_resolved_speeds(const Rig& rig);

}  // namespace crane::configuration
