#pragma once
/// Every number the supervisor decides by, in force from the load of the rig file on.
#include <algorithm>
#include <string>
#include <vector>

#include "crane/control/drive_limits.hpp"
#include "crane/control/operating_limits.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::supervisor {

/// One drive axis; "unit" is m (trolley, hoist) or rad (slew). The soft margin is at least the stopping
/// distance at max_speed.
using AxisLimits = control::DriveLimits;

/// What the rig file says of the machine, for the checks that compare it with its equations of motion.
struct MachineModel {
  bool known = false;  ///< false: neither following error nor swing encoders are judged
  plant::Parameters crane{};
  struct Friction {
    double rest_v = 0;     ///< the larger of stiction and Coulomb friction, V
    double viscous_v = 0;  ///< V per unit/s
  };
  std::array<Friction, kAxes> friction_positive{}, friction_negative{};  ///< by the direction of motion
  PerAxis resolution{};                                                  ///< of the encoders: one count, unit
  std::array<bool, 2> swing_measured{};                                  ///< radial, tangential
  std::array<double, 2> swing_resolution_rad{};
  bool cable_measured = false;
  double cable_m = 1;  ///< where it is not measured, > 0

  [[nodiscard]] double cable(double measured_m) const {
    constexpr double kShortest_m = 0.05;
    return cable_measured ? std::max(measured_m, kShortest_m) : cable_m;
  }
};

/// The base is section [limits] of the rig file.
struct Limits : control::OperatingLimits {
  std::array<AxisLimits, kAxes> axis{};
  double period_s = 0.01;             ///< tick
  double swing_runaway_ratio = 1.25;  ///< ramped stop above this multiple of it, >= 1
  int state_stale_after_ticks = 3;    ///< missing states in a row that stop the crane, >= 1
  int demand_stale_after_ticks = 3;   ///< ticks in a row without a usable demand that stop the crane, >= 1
  int demand_invalid_in_row =
      3;                    ///< demands in a row with a value that is not finite that stop the crane, >= 1
  int overruns_in_row = 3;  ///< late ticks in a row that stop the crane; 0: late ticks are only counted
  double clear_time_s = 1;  ///< causes clear for so long before a reset, streams fresh before arming, >= 0
  double standstill_time_s = 0.1;  ///< > 0
  double c1_ramp_time_s = 0.02;    ///< from the full to no voltage, in [0, 0.02]
  double stop_timeout_s = 8;       ///< controlled stop not at standstill by then: ramped stop, > 0
  double arm_match_time_s = 5;     ///< demand near zero and bridge ready within this time, > 0
  double arm_volt_limit_v = 2.5;   ///< demand that counts as near zero, > 0
  double brake_test_time_s =
      0.2;  ///< longer than the opening time: brakes have to report open within it, > 0
  double brake_report_time_s = 0.1;  ///< beyond the closing time: brakes have to report closed by then, > 0
  double load_still_rad = 0.005;     ///< a load that swings less when a bridge starts hangs at its zero, > 0
  double load_watch_s =
      10;  ///< for so long after the start of a bridge its load is looked at, >= clear_time_s
  MachineModel machine{};
  double creeping_ratio =
      2.5;  ///< an axis without a zero is too fast above this multiple of its homing speed, >= 1
};

/// Ticks a ramped stop takes, at least 1; the command of the last one is 0 V with the brakes closed.
[[nodiscard]] int ramp_ticks(const Limits& limits) noexcept;

/// t_detect + t_react + t_brake: one tick until the next sample can show the hazard, the ramp with the
/// one-tick delay of every command in it, and the closing of the brake.
[[nodiscard]] double stopping_time_s(const Limits& limits, std::size_t axis) noexcept;

/// v (t_detect + t_react + t_brake) + v^2 / 2a, for |speed|; unit.
[[nodiscard]] double stopping_distance(const Limits& limits, std::size_t axis, double speed) noexcept;

/// From the last demand of a dead controller to 0 V and closed brakes, in s.
[[nodiscard]] double demand_loss_to_braked_s(const Limits& limits) noexcept;

/// Largest permitted value of demand_loss_to_braked_s.
inline constexpr double kDemandLossToBrakedMax_s = 0.1;

/// True when an operator may ask for this target: finite and soft_margin inside the hard limits.
[[nodiscard]] bool target_allowed(const AxisLimits& axis, double target) noexcept;

/// Every problem as "name = value: rule"; empty when the crane may be armed with these limits.
[[nodiscard]] std::vector<std::string> problems(const Limits& limits);

}  // namespace crane::supervisor
