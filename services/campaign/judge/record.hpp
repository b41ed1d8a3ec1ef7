#pragma once
/// Record of a run for the judge: the published samples and the true state of every tick. Independent of
/// supervisor and bridge.
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "crane/plant/parameters.hpp"
#include "crane/topics.hpp"

namespace crane::campaign {

using plant::kAxes, plant::PerAxis;
using AxisFlags = std::array<bool, kAxes>;

/// True state of the rig.
struct Truth {
  PerAxis position{};  ///< m, rad, m of cable
  PerAxis speed{};     ///< m/s, rad/s, m/s of cable
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  PerAxis converter_v{};  ///< voltage at the drives
  AxisFlags brake_closed{};
  PerAxis written_v{};        ///< voltage that the bridge has written
  AxisFlags brake_release{};  ///< true: the bridge has switched the supply of the brake on
};

/// Truth, messages and requests at the end of one tick.
struct Row {
  std::int64_t time_ns = 0;
  Truth truth;
  msg::State state{};              ///< newest published
  msg::Command command{};          ///< newest sample of the supervisor
  msg::SupervisorStatus status{};  ///< newest published
  /// Newest published samples; only the recording uses them.
  msg::Reference reference{};
  msg::Contribution tracking{}, anti_swing{};
  msg::Demand demand{};
  bool reset_requested = false, arm_requested = false;  ///< requests of the operator in this tick
};

/// Reason of a stop: the cause of the supervisor, and for CAUSE_BRIDGE_LATCHED the reason of the bridge.
struct Reason {
  crane_Cause cause = crane_CAUSE_NONE;
  crane_LatchReason latch = crane_LATCH_NONE;
  [[nodiscard]] bool operator==(const Reason&) const = default;
};

/// Expected reaction to a fault.
struct Expectation {
  /// Correct reasons. A limit that the true state has crossed is also a correct reason. Empty: the crane must
  /// not stop.
  std::vector<Reason> reasons{};
  bool may_ride_through = false;  ///< true: it is also correct that the crane does not stop
  double detection_ms = 0;        ///< longest time from onset to the first reason
  bool communication = false;     ///< I2: 0 V within 70 ms of the onset
  /// true: the bridge has ended, and only the relay of the rig acts on the brakes
  bool volts_by_rig = false;
  /// true: wrong counters permit motion beyond a hard limit; I1 reports it only
  bool position_is_wrong = false;
  /// true: a command to stop may be lost; the bridge then stops the crane after 50 ms
  bool loses_commands = false;
  bool refused = false;  ///< true: the newest request of the operator must be refused
  /// volts_by_rig: longest time from onset to closed brakes: relay, coil and two ticks
  double braked_by_rig_ms = 90;
  bool supervisor_gone = false;  ///< true: no supervisor follows a latch of the bridge
  /// true: the status of the supervisor is wrong; only the bridge is judged
  bool supervisor_faulty = false;
  /// delay of the bridge; added to the permitted times until 0 V and closed brakes
  double bridge_delay_ms = 0;
  /// The bridge must latch with this reason, even after a stop by the supervisor; LATCH_NONE: no requirement.
  crane_LatchReason bridge_must_latch = crane_LATCH_NONE;
  /// The supervisor must report this cause, even after a latch of the bridge; CAUSE_NONE: no requirement.
  crane_Cause supervisor_must_find = crane_CAUSE_NONE;
  double independent_ms =
      0;  ///< longest permitted time of both requirements, from the visibility of the fault
  /// After STOPPING_ENVELOPE no voltage may drive this axis in the direction `outwards`; nothing: no
  /// requirement.
  std::optional<std::size_t> outwards_axis{};
  double outwards = 1;               ///< 1 or -1
  bool brakes_do_not_close = false;  ///< true: I3 and I4 do not apply, because a brake does not close
};

struct Run {
  std::vector<Row> rows{};
  std::int64_t begin_ns = 0;  ///< time before which there is no request and no fault
  std::int64_t onset_ns = 0;  ///< onset of the fault
  /// Earliest time at which the effect was visible; nothing: never.
  std::optional<std::int64_t> visible_ns{};
  Expectation expectation{};
  std::optional<bool> accepted{};  ///< answer to the newest request of the operator
};

}  // namespace crane::campaign
