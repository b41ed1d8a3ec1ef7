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
/// A brake that closes later than after 1 s cannot stop a crane of this project in time.
inline constexpr Range kBrakeTimes = Range::closed(0, 1);

inline constexpr std::array<fields::Field<DriveLimits>, 9> kDriveLimitFields{{
    {.key = "volt_limit_v",
     .member = &DriveLimits::volt_limit_v,
     .range = kDriveVolts,
     .unit = "V",
     .meaning = "largest voltage in either direction"},
    {.key = "volt_rate_limit_vps",
     .member = &DriveLimits::volt_rate_limit_vps,
     .range = Range::positive(),
     .unit = "V/s",
     .meaning = "the supervisor clamps faster changes"},
    {.key = "low_limit",
     .member = &DriveLimits::low_limit,
     .range = plant::kPositions,
     .meaning = "hard limit, below `high_limit`; of the hoist at least 0.001",
     .presence = Presence::required,
     .quantity = Quantity::position},
    {.key = "high_limit",
     .member = &DriveLimits::high_limit,
     .range = plant::kPositions,
     .meaning = "hard limit",
     .presence = Presence::required,
     .quantity = Quantity::position},
    {.key = "soft_margin",
     .member = &DriveLimits::soft_margin,
     .range = Range::not_negative(),
     .meaning = "operator targets stay this far inside; see below",
     .presence = Presence::required,
     .quantity = Quantity::position},
    {.key = "max_speed",
     .member = &DriveLimits::max_speed,
     .range = Range::positive(),
     .meaning = "overspeed trip",
     .presence = Presence::required,
     .quantity = Quantity::speed},
    {.key = "brake_deceleration",
     .member = &DriveLimits::brake_deceleration,
     .range = Range::positive(),
     .meaning = "what the closed brake gives at least",
     .presence = Presence::required,
     .quantity = Quantity::acceleration},
    {.key = "brake_close_time_s",
     .member = &DriveLimits::brake_close_time_s,
     .range = kBrakeTimes,
     .unit = "s",
     .meaning = "from the command to the closed brake"},
    {.key = "brake_open_time_s",
     .member = &DriveLimits::brake_open_time_s,
     .range = kBrakeTimes,
     .unit = "s",
     .meaning = "from the command to the open brake"},
}};

inline constexpr std::array<fields::Field<Homing>, 5> kHomingFields{{
    {.key = "position",
     .member = &Homing::position,
     .range = plant::kPositions,
     .meaning =
         "where the mark's switch changes: within the limits; of a limit switch within the soft margin "
         "of its limit",
     .quantity = Quantity::position,
     .default_text = "the limit; of `input` required"},
    {.key = "speed",
     .member = &Homing::speed,
     .range = Range::positive(),
     .meaning = "of the search, at most `reference_speed`",
     .quantity = Quantity::speed,
     .default_text = "0.1 `reference_speed`"},
    {.key = "approach_speed",
     .member = &Homing::approach_speed,
     .range = Range::positive(),
     .meaning = "of the second approach, which counts; at most `speed`",
     .quantity = Quantity::speed,
     .default_text = "0.2 `speed`",
     .derived = [](const Homing& homing) { return 0.2 * homing.speed; }},
    {.key = "back_off",
     .member = &Homing::back_off,
     .range = Range::positive(),
     .meaning = "beyond the opening of the switch; also how far from its place a mark may be seen later",
     .quantity = Quantity::position,
     .default_text = "0.02"},
    {.key = "volt_limit_v",
     .member = &Homing::volt_limit_v,
     .range = kDriveVolts,
     .unit = "V",
     .meaning = "largest voltage of an axis without a zero; at most the drive's `volt_limit_v`",
     .default_text = "5, or less where the drive has less"},
}};

}  // namespace crane::control
