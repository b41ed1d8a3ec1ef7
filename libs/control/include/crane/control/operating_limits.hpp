#pragma once
/// Section [limits] of a rig file: limits of the whole crane, with their table of fields. Rig file,
/// supervisor and bridge use this description. A new limit is one member and one row here.
#include "crane/plant/parameter_fields.hpp"

namespace crane::control {

struct OperatingLimits {
  double swing_limit_rad = 0.7;        ///< a larger swing angle stops the crane, rad
  double stale_after_s = 0.05;         ///< bridge: age of the command that stops the crane, s
  double demand_stale_after_s = 0.03;  ///< supervisor: time without a demand that stops the crane, s
  double idle_lock_s = 60;             ///< time in HOLD without a move that locks the crane, s
  bool model_checks = true;  ///< true: following error and swing encoders are compared with the model

  bool operator==(const OperatingLimits&) const = default;
};

/// A limit above plant::kSwingAngles would have no effect.
inline constexpr fields::Range kSwingLimitRange = fields::Range::above(0, plant::kSwingAngles.high);
/// At most one day.
inline constexpr fields::Range kIdleTimeRange = fields::Range::above(0, 86400);
/// At most 0.1 s: at 1 m/s an axis moves 0.1 m in this time, the smallest soft margin of the deployed
/// rigs.
inline constexpr fields::Range kStaleTimeRange = fields::Range::above(0, 0.1);

inline constexpr std::array kOperatingLimitFields{
    fields::Field<OperatingLimits>{.key = "swing_limit_rad",
                                   .member = &OperatingLimits::swing_limit_rad,
                                   .range = kSwingLimitRange,
                                   .unit = "rad",
                                   .meaning = "a larger swing angle stops the crane"},
    fields::Field<OperatingLimits>{.key = "stale_after_s",
                                   .member = &OperatingLimits::stale_after_s,
                                   .range = kStaleTimeRange,
                                   .unit = "s",
                                   .meaning = "the bridge stops the crane when the newest command is older; "
                                              "rounded down to whole ticks, at least one"},
    fields::Field<OperatingLimits>{.key = "demand_stale_after_s",
                                   .member = &OperatingLimits::demand_stale_after_s,
                                   .range = kStaleTimeRange,
                                   .unit = "s",
                                   .meaning = "the supervisor stops the crane after this time without a "
                                              "demand; rounded down to whole ticks, at "
                                              "least one"},
    fields::Field<OperatingLimits>{.key = "idle_lock_s",
                                   .member = &OperatingLimits::idle_lock_s,
                                   .range = kIdleTimeRange,
                                   .unit = "s",
                                   .meaning = "the crane locks after this time in HOLD without a move"},
    fields::Field<OperatingLimits>{.key = "model_checks",
                                   .member = &OperatingLimits::model_checks,
                                   .meaning = "true: the supervisor compares the motion of the axes and of "
                                              "the load with the model of this file "
                                              "(FOLLOWING_ERROR, SWING_SENSOR in `docs/safety.md`)"},
};

}  // namespace crane::control
