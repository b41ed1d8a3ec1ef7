#pragma once
/// What a run leaves for the judge: every tick the samples that were published and the truth that no sensor
/// knows. Nothing here comes from supervisor or bridge.
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "crane/topics.hpp"

namespace crane::campaign {

inline constexpr std::size_t kAxes = 3;
using PerAxis = std::array<double, kAxes>;
using AxisFlags = std::array<bool, kAxes>;

/// The rig at one instant, as nature has it.
struct Truth {
  PerAxis position{};  ///< m, rad, m of cable
  PerAxis speed{};     ///< per second
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  PerAxis converter_v{};  ///< what the drives get
  AxisFlags brake_closed{};
  PerAxis written_v{};        ///< what the bridge asked the board for
  AxisFlags brake_release{};  ///< the same
};

/// One tick, as it stood when the tick was over.
struct Row {
  std::int64_t time_ns = 0;
  Truth truth;
  msg::State state{};              ///< newest published
  msg::Command command{};          ///< newest that the supervisor published
  msg::SupervisorStatus status{};  ///< newest published
  msg::Reference
      reference{};  ///< this and the next two lines: newest published, for the recording, not for the judge
  msg::Contribution tracking{}, anti_swing{};
  msg::Demand demand{};
  bool reset_asked = false, arm_asked = false;  ///< by the operator, in this tick
};

/// Why the crane was stopped: the cause of the supervisor, and for CAUSE_BRIDGE_LATCHED the bridge's reason.
struct Reason {
  crane_Cause cause = crane_CAUSE_NONE;
  crane_LatchReason latch = crane_LATCH_NONE;
  [[nodiscard]] bool operator==(const Reason&) const = default;
};

/// What has to come of a fault.
struct Expectation {
  /// Any of them is right, and beside them the limit that the truth has crossed; empty: nothing may stop the
  /// crane.
  std::vector<Reason> reasons{};
  bool may_ride_through = false;   ///< no stop is right, too
  double detection_ms = 0;         ///< from onset to the first reason
  bool communication = false;      ///< I2: 0 V within 70 ms of the onset
  bool volts_by_rig = false;       ///< the bridge is dead: only the relay of the rig acts, on the brakes
  bool position_is_false = false;  ///< I1 cannot be kept by counters: travel beyond a hard limit is reported
  bool loses_commands = false;   ///< a command that stops the crane may be lost: the bridge stops it at 50 ms
  bool refused = false;          ///< the newest request of the operator is to be refused
  double braked_by_rig_ms = 90;  ///< volts_by_rig: from onset to closed brakes: relay, coil and two ticks
  bool supervisor_gone = false;  ///< nobody follows a latch of the bridge
  bool supervisor_mad = false;   ///< what it says is no evidence: only the bridge is judged
  double acts_late_ms =
      0;  ///< the bridge itself is late by so much: added to the times until volts and brakes
  /// The bridge has to find this by itself, whatever the supervisor did before; LATCH_NONE: nothing.
  crane_LatchReason latch_too = crane_LATCH_NONE;
  /// The same for the supervisor, whatever the bridge did before; CAUSE_NONE: nothing.
  crane_Cause cause_too = crane_CAUSE_NONE;
  double too_ms = 0;  ///< latch_too and cause_too: from the time the fault was visible
  std::optional<std::size_t> outwards_axis{};  ///< after STOPPING_ENVELOPE no voltage drives this axis ...
  double outwards = 1;                         ///< ... to this side
  bool brakes_are_broken = false;              ///< I3 and I4 say nothing about a brake that does not close
};

struct Run {
  std::vector<Row> rows{};
  std::int64_t begin_ns = 0;                 ///< until then nothing was done to the crane
  std::int64_t onset_ns = 0;                 ///< of the fault
  std::optional<std::int64_t> visible_ns{};  ///< when its effect could be seen at the earliest; none: never
  Expectation expectation{};
  std::optional<bool> accepted{};  ///< what came of the operator's newest request
};

}  // namespace crane::campaign
