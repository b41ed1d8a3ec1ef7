#pragma once
/// Limits and times of the supervisor, constant during a run. limits_of() takes some of them from the rig
/// file; the others keep the defaults below.
#include <algorithm>
#include <string>
#include <vector>

#include "crane/control/controlled_stop.hpp"
#include "crane/control/drive_limits.hpp"
#include "crane/control/filters.hpp"
#include "crane/control/operating_limits.hpp"
#include "crane/control/path.hpp"
#include "crane/control/zone.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::supervisor {

/// One drive axis; "unit" is m (trolley, hoist) or rad (slew). The soft margin is at least the stopping
/// distance at max_speed.
using AxisLimits = control::DriveLimits;

/// Parameters from the rig file for the checks that compare the crane with its equations of motion.
struct MachineModel {
  bool known = false;  ///< false: following error and swing encoders are not checked
  plant::Parameters crane{};
  struct Friction {
    double rest_v = 0;  ///< the larger of stiction and Coulomb friction, V
    double viscous_vs_per_unit = 0;
  };
  std::array<Friction, kAxes> friction_positive{}, friction_negative{};  ///< by the direction of motion
  PerAxis resolution{};                                                  ///< one count of the encoder, unit
  std::array<bool, 2> swing_measured{};                                  ///< radial, tangential
  std::array<double, 2> swing_resolution_rad{};
  bool swing_filtered = false;            ///< true: crane/state contains filtered swing angles
  control::FilterSection swing_filter{};  ///< of these angles, one step per tick
  int swing_filter_ticks = 0;             ///< ticks until this filter has settled; 0 without filter
  bool cable_measured = false;
  double cable_m = 1;  ///< length of a cable that is not measured, > 0

  [[nodiscard]] double cable(double measured_m) const {
    constexpr double kShortest_m = 0.05;
    return cable_measured ? std::max(measured_m, kShortest_m) : cable_m;
  }
};

/// The base is section [limits] of the rig file.
struct Limits : control::OperatingLimits {
  std::array<AxisLimits, kAxes> axis{};
  double period_s = 0.01;             ///< duration of a tick
  double swing_runaway_ratio = 1.25;  ///< ramped stop above this multiple of swing_limit_rad, >= 1
  int state_stale_after_ticks = 3;    ///< consecutive missing states that stop the crane, >= 1
  int demand_stale_after_ticks = 3;   ///< consecutive ticks without a usable demand that stop the crane, >= 1
  int demand_invalid_in_row = 3;      ///< consecutive rejected demands that stop the crane, >= 1
  /// consecutive late ticks that stop the crane; 0: late ticks do not stop the crane
  int overruns_in_row = 3;
  double clear_time_s = 1;  ///< time without a cause before a reset, >= 0
  double fresh_time_s = 1;  ///< time with fresh state and demand before arming, >= 0
  /// longest time in RUN until Inputs::reference_moving becomes true, >= 0. In the process, a move
  /// that the planner does not begin ends earlier, 0.2 s after its acceptance
  /// (OperatorRequests::is_moving)
  double longest_wait_for_motion_s = 1;
  double standstill_time_s = 0.1;  ///< time near one position that counts as standstill, > 0
  double c1_ramp_time_s = 0.02;    ///< duration of the ramp from full voltage to 0 V, in [0, 0.02]
  double stop_timeout_s =
      control::kControlledStop_s;  ///< longest controlled stop; a ramped stop follows, > 0
  double arm_match_time_s = 5;     ///< longest wait of ARMING for a demand near zero and a ready bridge, > 0
  double arm_volt_limit_v = 2.5;   ///< largest demand that counts as near zero, > 0
  /// longest time until a brake reports open, longer than its opening time, > 0
  double brake_test_time_s = 0.2;
  /// longest time from the end of the closing time until a brake reports closed, > 0
  double brake_report_time_s = 0.1;
  double relay_timeout_s = 0.05;  ///< longest time from the last toggle until the relay opens, > 0
  /// longest time from the end of relay_timeout_s until the relay reports open, > 0
  double relay_report_time_s = 0.1;
  double load_still_rad = 0.005;  ///< largest swing that counts as rest after a restart of the bridge, > 0
  /// time after a restart of the bridge in which the load must stay at rest, >= clear_time_s
  double load_watch_s = 10;
  MachineModel machine{};
  control::Clearance clearance{};
  std::vector<control::Zone> zones{};  ///< empty: the zone filter has no effect
  control::PathSpace path_space{};     ///< input of the search for moves around zones
  /// deceleration of the planner's stop, unit/s^2; 0: the zone filter requires no controlled stop
  /// before the ramped stop
  PerAxis reference_acceleration{};
  /// Largest distance between an axis and the start of a reference of sines, unit: reference_speed^2 /
  /// (2 reference_acceleration), the distance in which a move reaches its speed.
  PerAxis largest_follow_jump{};
  /// overspeed of an axis without known position: multiple of its homing speed, >= 1
  double homing_overspeed_ratio = 2.5;
};

/// Number of ticks of a ramped stop, at least 1. The command of the last tick is 0 V with closed brakes.
[[nodiscard]] int ramp_ticks(const Limits& limits) noexcept;

/// t_detect + t_react + t_brake, s. t_detect: one tick until the next sample shows the cause; t_react: the
/// ramp, including the delay of one tick of each command; t_brake: the closing time of the brake.
[[nodiscard]] double stopping_time_s(const Limits& limits, std::size_t axis) noexcept;

/// v (t_detect + t_react + t_brake) + v^2 / 2a, for |speed|; unit.
[[nodiscard]] double stopping_distance(const Limits& limits, std::size_t axis, double speed) noexcept;

/// Time from the last demand of a controller that has ended to 0 V and closed brakes, s.
[[nodiscard]] double demand_loss_to_braked_s(const Limits& limits) noexcept;

/// Largest permitted value of demand_loss_to_braked_s.
inline constexpr double kDemandLossToBrakedMax_s = 0.1;

/// True when `target` is finite and inside the soft limits.
[[nodiscard]] bool target_allowed(const AxisLimits& axis, double target) noexcept;

/// @return all problems as "name = value: rule"; empty when the crane may be armed with these limits
[[nodiscard]] std::vector<std::string> problems(const Limits& limits);

}  // namespace crane::supervisor
