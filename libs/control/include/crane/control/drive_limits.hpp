#pragma once
/// Limits and homing of one motor axis. Rig file, supervisor and bridge use this description.
/// "unit" is m (trolley, hoist) or rad (slew).
#include <cstdint>

namespace crane::control {

/// Origin of the position of an axis.
enum class Zero : std::uint8_t {
  start,     ///< assumed: the operator has moved the axis to the position in [start] before the bridge starts
  absolute,  ///< an absolute encoder measures the position
  homing     ///< unknown until homing has found the mark
};

/// Switch that marks a known position.
enum class Mark : std::uint8_t {
  limit_low,   ///< the low limit switch
  limit_high,  ///< the high limit switch
  input        ///< a separate switch, closed while the axis is below the position of the mark
};

struct Homing {
  Mark mark = Mark::limit_low;
  double position = 0;        ///< position at which the switch of the mark changes, unit
  double speed = 0;           ///< of the search and of the motions away from the mark, unit/s
  double approach_speed = 0;  ///< of the second approach, which determines the position, unit/s
  /// Distance that the axis backs off after the switch has opened, unit. Also the tolerance of the position
  /// of the mark in later passes.
  double back_off = 0;
  double volt_limit_v = 5;  ///< largest voltage while the position is unknown, V
  /// Direction of motion towards the mark: -1 down, 1 up.
  [[nodiscard]] double direction() const { return mark == Mark::limit_high ? 1 : -1; }

  bool operator==(const Homing&) const = default;
};

/// Ranges: drive_limit_fields.hpp.
struct DriveLimits {
  bool present = false;               ///< false: the rig has no such axis
  double volt_limit_v = 10;           ///< largest |V|, V
  double volt_rate_limit_vps = 1000;  ///< largest change of the voltage, V/s
  double low_limit = 0;               ///< hard limit, unit
  double high_limit = 0;              ///< hard limit, unit
  double soft_margin = 0;             ///< minimum distance of a target from the hard limits, unit
  double max_speed = 0;               ///< a higher speed stops the crane, unit/s
  double brake_deceleration = 0;      ///< smallest deceleration by the closed brake, unit/s^2
  double brake_close_time_s = 0.02;   ///< time from the loss of supply until the brake is closed, s
  double brake_open_time_s = 0.02;    ///< time from the supply of the brake until the brake is open, s
  double standstill_speed = 0.005;    ///< a lower speed counts as standstill, unit/s
  double brake_slip = 0.02;  ///< permitted motion with a closed brake after the braking distance, unit
  Zero zero = Zero::start;
  Homing homing{};  ///< used when zero is Zero::homing

  [[nodiscard]] bool homes() const { return present && zero == Zero::homing; }
  /// Initial position of an axis with unknown position: the limit that is farther from the mark. The
  /// displayed position then stays inside the limits until the axis reaches the mark, from any start.
  [[nodiscard]] double unhomed_position() const { return homing.direction() < 0 ? high_limit : low_limit; }

  bool operator==(const DriveLimits&) const = default;
};

}  // namespace crane::control
