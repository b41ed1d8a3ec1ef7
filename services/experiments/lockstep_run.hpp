#pragma once
/// Runs a scenario in lockstep: reset, arm, moves and kicks at exact ticks; collects every tick. A stack of
/// processes and an in-process stack give the same result, bit for bit.
#include <functional>
#include <span>
#include <string>

#include "crane/experiment/scenario.hpp"
#include "crane/runtime/component.hpp"
#include "experiments/tick_log.hpp"
#include "stack/operator_client.hpp"

namespace crane::experiments {

/// The stack makes no progress or refuses a request, or one of its processes has ended. what() names the
/// reason.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct RunOutcome {
  std::uint64_t hold_tick = 0;  ///< tick of scenario time 0
  std::uint64_t last_tick = 0;
  bool completed = false;       ///< false: the supervisor stopped the crane
  std::string stopped_because;  ///< cause of the stop, name of "CAUSE_..." in crane.idl; empty when completed
  double wall_s = 0;            ///< wall time of all ticks
};

/// Polls the stack or waits for it; called while the run waits. @throws RunError when the stack cannot
/// continue
using Pump = std::function<void()>;

/// @param bus         bus of the operator, not of the control loop
/// @param components  components of the stack; every loop topic that they write is recorded in every tick
[[nodiscard]] RunOutcome run_scenario(bus::Bus& bus, const Pump& pump, const configuration::Rig& rig,
                                      const experiment::Scenario& scenario, TickLog& log,
                                      std::span<const runtime::ComponentSpec> components);

}  // namespace crane::experiments
