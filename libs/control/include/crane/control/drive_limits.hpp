#pragma once
/// What one motor axis may do, and how its zero is known: one description for the rig file, the supervisor
/// and the bridge's last line. "unit" is m (trolley, hoist) or rad (slew).
#include <cstdint>

namespace crane::control {

/// How it is known where an axis stands.
enum class Zero : std::uint8_t {
  start,     ///< by assumption: somebody has put the axis where [start] says before the bridge was started
  absolute,  ///< what the encoder shows is the position
  homing     ///< not before the axis has crept to its mark
};

/// What is found at a known place.
enum class Mark : std::uint8_t {
  limit_low,   ///< the limit switch at the low end
  limit_high,  ///< the limit switch at the high end
  input        ///< a switch of its own, closed wherever the axis is below the mark's position
};

struct Homing {
  Mark mark = Mark::limit_low;
  double position = 0;  ///< where the mark's switch changes, unit
  double speed = 0;     ///< of the search, and the fastest that an axis without a zero may creep, unit/s
  double approach_speed = 0;  ///< of the second approach, which counts, unit/s
  double back_off = 0;        ///< beyond the opening of the switch, unit
  double volt_limit_v = 5;    ///< most volts for an axis without a zero
  /// From here the mark is reached by going down: -1, or up: 1.
  [[nodiscard]] double direction() const { return mark == Mark::limit_high ? 1 : -1; }

  bool operator==(const Homing&) const = default;
};

/// Ranges: drive_limit_fields.hpp.

struct DriveLimits {
  bool present = false;
  double volt_limit_v = 10;           ///< |V| <=
  double volt_rate_limit_vps = 1000;  ///< V/s
  double low_limit = 0;               ///< hard limit, unit
  double high_limit = 0;              ///< hard limit, unit
  double soft_margin = 0;             ///< operator targets stay this far inside the hard limits, unit
  double max_speed = 0;               ///< overspeed trip, unit/s
  double brake_deceleration = 0;      ///< what the closed brake gives at least, unit/s^2
  double brake_close_time_s = 0.02;
  double brake_open_time_s = 0.02;
  double standstill_speed = 0.005;  ///< slower than this counts as standing, unit/s, > 0
  double brake_slip = 0.02;  ///< displacement a closed brake may allow beyond the braking distance, unit, > 0
  Zero zero = Zero::start;
  Homing homing{};  ///< where zero is Zero::homing

  [[nodiscard]] bool homes() const { return present && zero == Zero::homing; }
  /// What the counter of an axis that homes is preset to. The end that is farther from the mark: whatever
  /// stands between, what is shown on the way to the mark stays inside the limits.
  [[nodiscard]] double unhomed_position() const { return homing.direction() < 0 ? high_limit : low_limit; }

  bool operator==(const DriveLimits&) const = default;
};

}  // namespace crane::control
