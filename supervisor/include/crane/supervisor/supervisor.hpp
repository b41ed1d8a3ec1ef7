#pragma once
/// One tick of the supervisor: sample and demand in, command and status out. Everything between the topics,
/// without them.
#include "crane/supervisor/gate.hpp"
#include "crane/supervisor/homing.hpp"
#include "crane/supervisor/motion.hpp"
#include "crane/supervisor/pendulum.hpp"
#include "crane/supervisor/restart.hpp"
#include "crane/supervisor/state_machine.hpp"

namespace crane::supervisor {

/// What crane/state says.
struct Sample {
  double time_s = 0;  ///< when it was latched, by the clock of the bridge
  PerAxis position{};
  double swing_radial_rad = 0;
  double swing_tangential_rad = 0;
  AxisFlags brake_closed{};
  AxisFlags limit_low{}, limit_high{};
  bool estop_pressed = false;
  bool command_stale = false;    ///< latched by the bridge
  bool command_invalid = false;  ///< latched by the bridge
  bool watchdog_dropped = false;
  std::uint32_t overruns = 0;    ///< late ticks so far
  AxisFlags position_unknown{};  ///< the axis has to be homed
  AxisFlags mark_active{};       ///< it stands on its mark
  AxisFlags mark_found{};        ///< the bridge has seen the mark at the same place twice
  PerAxis applied_v{};           ///< acts from this sample on
};

struct TickInput {
  double now_s =
      0;  ///< by the supervisor's own clock, which never goes back; silence and idle are judged by it
  std::uint64_t tick = 0;
  bool state_arrived = false;  ///< false: the wait for the state ran out; the step is due all the same
  Sample sample{};  ///< read only when state_arrived; a value that is not finite makes it not arrived
  bool bridge_restarted = false;  ///< from here on a younger bridge speaks; its ticks begin anew
  bool demand_arrived = false;
  PerAxis demand_v{};
  bool reference_moving = false;
  bool second_writer = false;
  bool foreign_command = false;    ///< the bridge gives voltages that this supervisor has not commanded
  bool brake_open_untold = false;  ///< a brake is open long after it was told to close
  SelfTest self_test = SelfTest::not_started;
  Requests requests{};
  std::size_t home_axis = 0;  ///< whom Request::home is about, < kAxes
  AxisFlags confirmed{};  ///< Request::reset: the operator has seen that the axis stands where it is said to
};

struct TickMemory {
  Memory machine{};
  HomingMemory homing{};
  std::size_t homing_axis = 0;  ///< read only while machine.homing
  GateMemory gate{};
  MotionMemory motion{};
  BrakeMemory brakes{};
  RestartMemory restart{};
  FollowingMemory following{};
  PendulumMemory pendulum{};
  Sample sample{};  ///< newest
  int state_missing_in_row = 0;
  int overruns_in_row = 0;
  PerAxis ramp_from_v{};       ///< voltage at the beginning of the ramp
  PerAxis release_position{};  ///< where the axes stood when the brakes were told to open
};

/// Fields of crane/supervisor; false = healthy.
struct StatusFlags {
  bool state_stale = false;
  bool demand_stale = false;
  bool demand_invalid = false;
  bool demand_clamped = false;
  bool envelope_violated = false;
  bool swing_exceeded = false;
  bool bridge_latched = false;
  bool estop_active = false;
  bool second_writer = false;
};

struct TickOutput {
  State state = State::boot;
  Cause cause = Cause::start;
  StatusFlags flags{};
  PerAxis drive_v{};  ///< V
  AxisFlags brake_release{};
  AxisFlags homing{};                                  ///< the axis that creeps to its mark
  PerAxis homing_speed{};                              ///< of its reference, unit/s
  HomingFailure homing_failure = HomingFailure::none;  ///< of the last homing
  bool watchdog_permission = false;
  bool stop_motion = false;
  std::array<Answer, kRequests> answers{};
  std::uint64_t clamped_count = 0;
  std::uint64_t rejected_count = 0;
  std::uint64_t missing_demand_count = 0;
};

/// @pre problems(limits).empty()
[[nodiscard]] TickOutput step(const Limits& limits, const TickInput& input, TickMemory& memory) noexcept;

}  // namespace crane::supervisor
