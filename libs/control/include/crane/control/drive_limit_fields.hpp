#pragma once
/// Fields of [drive.NAME] and [homing.NAME] of a rig file that limit the motion of an axis. Rig file and
/// supervisor use them.
#include "crane/control/drive_limits.hpp"
#include "crane/plant/parameter_fields.hpp"

namespace crane::control {

using fields::Presence;
using fields::Quantity;
using fields::Range;

/// Range of an analog output: +-10 V.
inline constexpr Range kDriveVolts = Range::above(0, 10);
/// Opening and closing times, s. A brake that closes later than after 1 s cannot stop the crane in time.
inline constexpr Range kBrakeTimeRange = Range::closed(0, 1);

inline constexpr std::array<fields::Field<DriveLimits>, 9> kDriveLimitFields{{
    {.key = "volt_limit_v",
     .member = &DriveLimits::volt_limit_v,
     .range = kDriveVolts,
     .unit = "V",
     .meaning = "largest absolute voltage"},
    {.key = "volt_rate_limit_vps",
     .member = &DriveLimits::volt_rate_limit_vps,
     .range = Range::positive(),
     .unit = "V/s",
     .meaning = "largest rate of change of the voltage; the gate of the supervisor limits faster changes"},
    {.key = "low_limit",
     .member = &DriveLimits::low_limit,
     .range = plant::kPositions,
     .meaning = "lowest permitted position (hard limit), below `high_limit`; for the hoist at least 0.001",
     .presence = Presence::required,
     .quantity = Quantity::position},
    {.key = "high_limit",
     .member = &DriveLimits::high_limit,
     .range = plant::kPositions,
     .meaning = "highest permitted position (hard limit)",
     .presence = Presence::required,
     .quantity = Quantity::position},
    {.key = "soft_margin",
     .member = &DriveLimits::soft_margin,
     .range = Range::not_negative(),
     .meaning = "minimum distance of the target of a move from both hard limits; at least the stopping "
                "distance, see "
                "below",
     .presence = Presence::required,
     .quantity = Quantity::position},
    {.key = "max_speed",
     .member = &DriveLimits::max_speed,
     .range = Range::positive(),
     .meaning = "largest permitted speed; a higher speed stops the crane (OVERSPEED)",
     .presence = Presence::required,
     .quantity = Quantity::speed},
    {.key = "brake_deceleration",
     .member = &DriveLimits::brake_deceleration,
     .range = Range::positive(),
     .meaning = "smallest deceleration that the closed brake guarantees",
     .presence = Presence::required,
     .quantity = Quantity::acceleration},
    {.key = "brake_close_time_s",
     .member = &DriveLimits::brake_close_time_s,
     .range = kBrakeTimeRange,
     .unit = "s",
     .meaning = "time from the loss of the brake supply until the brake is closed"},
    {.key = "brake_open_time_s",
     .member = &DriveLimits::brake_open_time_s,
     .range = kBrakeTimeRange,
     .unit = "s",
     .meaning = "time from the supply of the brake until the brake is open"},
}};

inline constexpr std::array<fields::Field<Homing>, 5> kHomingFields{{
    {.key = "position",
     .member = &Homing::position,
     .range = plant::kPositions,
     .meaning = "position at which the switch of the mark changes; inside the limits, and for a limit switch "
                "at most "
                "the soft margin from its limit",
     .quantity = Quantity::position,
     .default_text = "the limit; required for `input`"},
    {.key = "speed",
     .member = &Homing::speed,
     .range = Range::positive(),
     .meaning = "speed of the search, at most `reference_speed`",
     .quantity = Quantity::speed,
     .default_text = "0.1 `reference_speed`"},
    {.key = "approach_speed",
     .member = &Homing::approach_speed,
     .range = Range::positive(),
     .meaning = "speed of the second approach, which sets the position; at most `speed`",
     .quantity = Quantity::speed,
     .default_text = "0.2 `speed`",
     .derived = [](const Homing& homing) { return 0.2 * homing.speed; }},
    {.key = "back_off",
     .member = &Homing::back_off,
     .range = Range::positive(),
     .meaning = "distance that the axis backs off after the switch has opened; also the tolerance of the "
                "position of "
                "the mark in later passes",
     .quantity = Quantity::position,
     .default_text = "0.02"},
    {.key = "volt_limit_v",
     .member = &Homing::volt_limit_v,
     .range = kDriveVolts,
     .unit = "V",
     .meaning = "largest voltage while the position is unknown; at most `volt_limit_v` of the drive",
     .default_text = "5, or that of the drive if lower"},
}};

}  // namespace crane::control
