#pragma once
/// One tick of the supervisor: a deterministic function of limits, inputs and memory that returns command
/// and status. No I/O; step() changes nothing but the memory.
/// process/samples.hpp converts from and to the topics.
#include "crane/supervisor/gate.hpp"
#include "crane/supervisor/homing.hpp"
#include "crane/supervisor/motion.hpp"
#include "crane/supervisor/pendulum.hpp"
#include "crane/supervisor/restart.hpp"
#include "crane/supervisor/state_machine.hpp"
#include "crane/supervisor/zone_filter.hpp"

namespace crane::supervisor {

/// The part of crane/state that the supervisor uses.
struct Sample {
  double time_s = 0;  ///< time at which the encoders were sampled, clock of the bridge
  PerAxis position{};
  double swing_radial_rad = 0;
  double swing_tangential_rad = 0;
  AxisFlags brake_closed{};
  AxisFlags limit_low{}, limit_high{};
  bool estop_pressed = false;
  bool command_stale = false;    ///< true: the bridge has latched because of an old or missing command
  bool command_invalid = false;  ///< true: the bridge has latched for any other reason
  bool watchdog_dropped = false;
  std::uint32_t overruns = 0;    ///< number of late ticks since the start of the bridge
  AxisFlags position_unknown{};  ///< true: the axis must be homed
  AxisFlags mark_active{};       ///< true: the axis is at its homing mark
  AxisFlags mark_found{};        ///< true: the bridge has detected the mark twice at the same position
  PerAxis applied_v{};           ///< V, acts from this sample on
};

/// The sample as input of the model checks. @param free  axes whose brake is commanded open and reports open
[[nodiscard]] FollowingInput following_input(const Sample& sample, const AxisFlags& free) noexcept;
[[nodiscard]] PendulumInput pendulum_input(const Sample& sample) noexcept;

struct TickInput {
  /// s, clock of the supervisor: time of the sample, or of the step when no state has arrived. A late sample
  /// can be older than the preceding step without a state. The clock measures silence and idle time.
  double now_s = 0;
  std::uint64_t tick = 0;
  bool state_arrived = false;  ///< false: no state arrived in time; the step runs without a state
  /// Valid when state_arrived. A sample whose time, position, swing angle or applied voltage is not finite
  /// counts as missing.
  Sample sample{};
  /// true: a new bridge writes crane/state from this tick on; its ticks start at 0
  bool bridge_restarted = false;
  bool demand_arrived = false;
  PerAxis demand_v{};
  bool reference_moving = false;
  bool second_writer = false;
  bool configuration_differs = false;
  /// true: the bridge outputs a voltage that this supervisor has not commanded
  bool foreign_command = false;
  bool brake_open_without_command = false;  ///< true: a brake is open long after the command to close
  SelfTest self_test = SelfTest::not_started;
  Requests requests{};
  std::size_t home_axis = 0;  ///< axis of Request::home, < kAxes
  double speed_share = 1;     ///< share of max_speed that the operating mode permits, (0, 1]
  AxisFlags confirmed{};  ///< Request::reset: the operator has confirmed the measured position of the axis
};

struct TickMemory {
  Memory machine{};
  HomingMemory homing{};
  std::size_t homing_axis = 0;  ///< valid while machine.homing or may_set_zero
  bool may_set_zero = false;    ///< true: the axis is being homed, or has been homed and has no position yet
  GateMemory gate{};
  MotionMemory motion{};
  BrakeMemory brakes{};
  RelayMemory relay{};
  bool relay_permitted = false;  ///< watchdog permission of the last command
  RestartMemory restart{};
  FollowingMemory following{};
  PendulumMemory pendulum{};
  ZoneMemory zones{};
  Sample sample{};  ///< newest usable sample
  int state_missing_in_row = 0;
  int overruns_in_row = 0;
  PerAxis ramp_from_v{};       ///< V, voltage at the start of the ramp
  PerAxis release_position{};  ///< positions when the brakes were commanded open
};

/// Newest sample and motion as input of the zone filter.
/// @param gate_output_v  V, output of the gate in this tick
[[nodiscard]] ZoneInput zone_input(const TickMemory& memory, const PerAxis& gate_output_v) noexcept;

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
  bool configuration_differs = false;
};

struct TickOutput {
  State state = State::boot;
  Cause cause = Cause::start;
  StatusFlags flags{};
  PerAxis drive_v{};  ///< V
  AxisFlags brake_release{};
  AxisFlags homing{};      ///< true: the axis is being homed, or has been homed and has no position yet
  PerAxis homing_speed{};  ///< speed of the reference, unit/s
  HomingFailure homing_failure = HomingFailure::none;  ///< result of the last homing
  bool watchdog_permission = false;
  bool stop_motion = false;
  std::size_t zone = 0;  ///< Cause::zone: index of the zone that requires the stop (zone_filter.hpp)
  std::array<Answer, kRequests> answers{};
  std::uint64_t clamped_count = 0;
  std::uint64_t rejected_count = 0;
  std::uint64_t missing_demand_count = 0;
};

/// @pre problems(limits).empty()
[[nodiscard]] TickOutput step(const Limits& limits, const TickInput& input, TickMemory& memory) noexcept;

}  // namespace crane::supervisor
