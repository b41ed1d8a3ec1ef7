#pragma once
/// The safety states. A pure function of what is seen in one tick, with its memory and the time as arguments.
#include "crane/supervisor/envelope.hpp"
#include "crane/supervisor/following.hpp"

namespace crane::supervisor {

enum class SelfTest : std::uint8_t { not_started, running, passed, failed };

enum class Request : std::uint8_t { reset, arm, disarm, move, stop, estop, home };
inline constexpr std::size_t kRequests = 7;
using Requests = std::array<bool, kRequests>;  ///< indexed by Request: asked for in this tick

/// What is seen in this tick. Flags: false = healthy, unless their name says otherwise.
struct Inputs {
  double now_s = 0;  ///< time of the sample, never runs backwards
  SelfTest self_test = SelfTest::not_started;
  bool state_stale = false;
  bool demand_stale = false;
  Cause gate_cause = Cause::none;  ///< none, demand_stale, demand_invalid, demand_rate
  EnvelopeInput measured{};        ///< for rules that compare a measured value with a limit
  Envelope envelope{};
  bool following_error = false;      ///< see following.hpp
  bool swing_sensor_failed = false;  ///< see pendulum.hpp
  bool estop_pressed = false;
  bool bridge_latched = false;    ///< the bridge holds 0 V and closed brakes by itself
  bool watchdog_dropped = false;  ///< the relay has removed the brake supply
  bool second_writer = false;
  bool foreign_command = false;   ///< the bridge gives voltages that nobody here has commanded
  bool bridge_restarted = false;  ///< another bridge writes crane/state; it is not tested yet
  bool place_unclear =
      false;  ///< since that restart: an axis may stand elsewhere, and the reset does not confirm it
  std::size_t unclear_axis = 0;     ///< the first such axis, < kAxes
  bool load_unclear = false;        ///< the load did not hang still when the bridge started
  bool overrun = false;             ///< too many late ticks in a row
  bool brake_failed = false;        ///< see motion.hpp
  bool moved_while_arming = false;  ///< an axis left its place while the brakes were being opened
  bool demand_near_zero = false;    ///< true: the demand matches a crane at rest
  bool brakes_open = false;         ///< true: every present brake reports open
  bool brakes_closed = true;        ///< true: every present brake reports closed
  bool standstill = false;          ///< true: every present axis stands
  bool reference_moving = false;    ///< true: the planner executes a maneuver
  bool not_homed = false;           ///< some axis has no zero
  std::size_t unhomed_axis = 0;     ///< the first of them, < kAxes
  bool can_home = true;             ///< true: the axis that is asked to home has a mark
  bool homed = false;               ///< true: the axis that is being homed has found its mark and left it
  HomingFailure homing_failure = HomingFailure::none;
  Requests requests{};
};

struct Memory {
  State state = State::boot;
  Cause cause = Cause::start;
  double entered_s = 0;        ///< when `state` was entered
  double clear_since_s = 0;    ///< nothing has stood against a reset since
  double fresh_since_s = 0;    ///< state and demand have been fresh since
  double idle_since_s = 0;     ///< HOLD: since when nothing has moved
  double release_since_s = 0;  ///< ARMING: when the brakes were told to open
  bool releasing = false;      ///< the brakes are told to open
  bool ramping = false;        ///< STOP_C1: past its controlled part
  int ramp_tick = 0;           ///< ticks of the ramp done
  bool maneuver_seen = false;  ///< RUN: the reference has moved
  bool reset_was_up = false;   ///< the reset was asked for in the tick before
  bool self_test_passed = false;
  bool homing = false;  ///< from ARMING on: for one axis, and for nothing but to home it
};

enum class Volts : std::uint8_t { zero, pass, ramp };

/// The answer to a request that was made. `reason` says why not and what to do; empty when accepted.
struct Answer {
  bool asked = false;
  bool accepted = false;
  const char* reason = "";
};

struct Outputs {
  State state = State::boot;
  Cause cause = Cause::start;  ///< none in READY, ARMING, HOLD and RUN
  Volts volts = Volts::zero;
  double ramp_factor =
      0;  ///< Volts::ramp: what is left of the voltage at the beginning of the ramp, in [0, 1)
  bool brake_release = false;  ///< for every present axis; while homing for that axis alone
  bool homing = false;
  bool watchdog_permission = false;
  bool stop_motion = false;  ///< the planner has to bring its reference to rest
  std::array<Answer, kRequests> answers{};
};

/// One tick. Total: any input in any state gives a defined output.
[[nodiscard]] Outputs step(const Limits& limits, const Inputs& inputs, Memory& memory) noexcept;

/// The drives obey the demands: HOLD, RUN and the controlled part of STOP_C1.
[[nodiscard]] bool drives_active(const Memory& memory) noexcept;

}  // namespace crane::supervisor
