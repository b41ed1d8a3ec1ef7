#pragma once
/// A scenario in lockstep: reset, arm, moves and kicks at exact ticks, every tick collected. The same on a
/// stack of processes and on a stack in one process, and on both with the same result, bit for bit.
#include <functional>
#include <string>

#include "crane/experiment/scenario.hpp"
#include "crane/runtime/component.hpp"
#include "experiments/tick_log.hpp"
#include "stack/operator_client.hpp"

namespace crane::experiments {

/// The stack stands still, refuses, or a process of it ended; what() names the reason.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct RunOutcome {
  std::uint64_t hold_tick = 0;  ///< tick at which the scenario's time is 0
  std::uint64_t last_tick = 0;
  bool completed = false;       ///< false: the supervisor stopped the crane
  std::string stopped_because;  ///< its cause, "CAUSE_..." of the IDL in words; empty when completed
  double wall_s = 0;            ///< time the ticks took
};

/// Lets the stack work a little; called while there is nothing to do. @throws RunError when it cannot go on
using Pump = std::function<void()>;

/// @param bus  the operator's own; not in the loop
/// @param with_twin  a twin runs beside the stack: its samples are collected, too
[[nodiscard]] RunOutcome run_scenario(bus::Bus& bus, const Pump& pump, const configuration::Rig& rig,
                                      const experiment::Scenario& scenario, TickLog& log,
                                      bool with_twin = false);

}  // namespace crane::experiments
