#pragma once
/// State machine of the supervisor: a deterministic function of the inputs of one tick, the memory and the
/// time. No I/O; step() changes nothing but the memory.
#include "crane/supervisor/envelope.hpp"
#include "crane/supervisor/following.hpp"

namespace crane::supervisor {

/// Self-test of the board at the start (process/board_self_test.hpp).
enum class SelfTest : std::uint8_t {
  not_started,  ///< until the first step of the supervisor
  running,      ///< the board must show 0 V, closed brakes and open relay in ten states in a row within 2 s
  passed,       ///< until the bridge restarts
  failed        ///< leads to FAULT, which only a restart of the supervisor ends
};

enum class Request : std::uint8_t { reset, arm, disarm, move, stop, estop, home };
inline constexpr std::size_t kRequests = 7;
using Requests = std::array<bool, kRequests>;  ///< indexed by Request; true: requested in this tick

/// Inputs of one tick.
struct Inputs {
  double now_s = 0;  ///< s, clock of the supervisor (TickInput::now_s)
  SelfTest self_test = SelfTest::not_started;
  bool state_stale = false;        ///< true: too many states in a row are missing
  bool demand_stale = false;       ///< true: too many ticks in a row have no usable demand
  Cause gate_cause = Cause::none;  ///< none, demand_stale, demand_invalid, demand_rate
  EnvelopeInput measured{};        ///< for rules that compare a measured value with a limit
  Envelope envelope{};
  bool following_error = false;        ///< true: see following.hpp
  bool swing_sensor_failed = false;    ///< true: see pendulum.hpp
  bool zone_ahead = false;             ///< true: see zone_filter.hpp
  bool zone_touched = false;           ///< true: see zone_filter.hpp
  bool estop_pressed = false;          ///< true: the emergency stop of the rig is pressed
  bool bridge_latched = false;         ///< true: the bridge holds 0 V and closed brakes by itself
  bool watchdog_dropped = false;       ///< true: the relay has removed the brake supply
  bool second_writer = false;          ///< true: a loop topic has a second writer
  bool configuration_differs = false;  ///< true: processes have different rig files or controllers
  bool foreign_command = false;        ///< true: the bridge outputs a voltage that no command explains
  bool bridge_restarted = false;       ///< true: this is the first tick of a new bridge
  bool position_doubtful = false;    ///< true: the restart has made the position of an axis doubtful, and no
                                     ///< reset has confirmed this position
  std::size_t doubtful_axis = 0;     ///< first axis with such a position, < kAxes
  bool swing_zero_doubtful = false;  ///< true: the load swung when the bridge started
  bool overrun = false;              ///< true: too many late ticks in a row
  bool brake_did_not_close = false;  ///< true: see motion.hpp
  bool relay_did_not_open = false;   ///< true: see motion.hpp
  bool relay_closed = false;         ///< true: the relay is still closed although its permission is withheld
  bool moved_while_arming = false;   ///< true: an axis moved while the brakes were being opened
  bool demand_near_zero = false;     ///< true: the demand matches a crane at rest
  bool brakes_open = false;          ///< true: every brake that arming opens reports open
  bool brakes_closed = true;         ///< true: every present brake reports closed
  bool standstill = false;           ///< true: every present axis is at rest
  bool reference_moving = false;     ///< true: a move or a session of the stick is in progress
  bool not_homed = false;            ///< true: the position of an axis has no known origin
  std::size_t unhomed_axis = 0;      ///< first axis with such a position, < kAxes
  std::size_t home_axis = 0;         ///< axis of Request::home, < kAxes
  bool can_home = true;              ///< true: home_axis has a homing mark
  bool homed = false;                ///< true: the homed axis has found its mark and left it
  HomingFailure homing_failure = HomingFailure::none;
  Requests requests{};
};

struct Memory {
  State state = State::boot;
  Cause cause = Cause::start;
  double entered_s = 0;      ///< time at which `state` was entered
  double clear_since_s = 0;  ///< last time at which a cause blocked a reset
  double fresh_since_s = 0;  ///< last time at which state or demand was stale
  /// HOLD: time at which HOLD was entered (end of arming or of a move)
  double idle_since_s = 0;
  double release_since_s = 0;           ///< ARMING: time at which the brakes were commanded open
  bool releasing = false;               ///< true: the brakes are commanded open
  bool ramping = false;                 ///< STOP_C1: true: the voltage ramps to zero
  int ramp_tick = 0;                    ///< number of ticks of the ramp so far
  bool move_began = false;              ///< RUN: true: reference_moving was true
  bool reset_requested_before = false;  ///< true: the previous tick requested a reset
  bool self_test_passed = false;
  bool homing = false;  ///< true: the crane is armed only to home one axis
};

/// Voltage of the drives.
enum class Volts : std::uint8_t {
  zero,  ///< 0 V
  pass,  ///< output of the gate
  ramp   ///< Outputs::ramp_factor times the voltage at the start of the ramp
};

/// Answer to one request. `reason` states cause and remedy of a refusal; it is empty for an accepted request.
struct Answer {
  bool requested = false;
  bool accepted = false;
  const char* reason = "";
};

struct Outputs {
  State state = State::boot;
  Cause cause = Cause::start;  ///< none in READY, ARMING, HOLD and RUN
  Volts volts = Volts::zero;
  double ramp_factor = 0;      ///< factor of Volts::ramp, in [0, 1)
  bool brake_release = false;  ///< true: open the brakes of all present axes; while homing, of the homed axis
  bool homing = false;
  bool watchdog_permission = false;
  bool stop_motion = false;  ///< true: the planner must bring its reference to rest
  std::array<Answer, kRequests> answers{};
};

/// Advances the state machine by one tick. The function is total: every input in every state has a defined
/// output.
[[nodiscard]] Outputs step(const Limits& limits, const Inputs& inputs, Memory& memory) noexcept;

/// True when the drives execute the demands: HOLD, RUN, and STOP_C1 before its ramp.
[[nodiscard]] bool drives_active(const Memory& memory) noexcept;

}  // namespace crane::supervisor
