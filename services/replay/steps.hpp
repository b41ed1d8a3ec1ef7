#pragma once
/// Determines which components stepped in a recorded tick, and with which inputs. In real time, a component
/// steps without an input that is late, or does not step. The samples of the tick and of the next tick show
/// what happened. If a later sample depends on a missing sample, the missing sample was published, but the
/// recorder did not receive it.
#include <cstdint>
#include <optional>
#include <string>

#include "crane/topics.hpp"

namespace crane::replay {

struct RecordedTick;

struct Steps {
  /// True: the planner did not publish the reference of this tick in the previous tick, and
  /// published it from the state of this tick.
  bool planner_begins = false;
  bool planner = true;             ///< true: the planner published the reference of the next tick
  bool planner_has_status = true;  ///< true: the status of this tick was published before the reference
  /// True: the status was published before the reference, but so late that the planner may have stepped
  /// without it. Only the recorded reference shows whether the planner had the status.
  bool planner_may_lack_status = false;
  bool tracking = true, anti_swing = true, friction = true;            ///< true: the law stepped
  bool supervisor = true;                                              ///< true: the supervisor stepped
  bool supervisor_has_demand = true, supervisor_has_reference = true;  ///< inputs of the supervisor's step
  std::int64_t supervisor_after_ns = 0;  ///< time from the state to the command; 0: unknown
};

/// True: the supervisor has stepped, although the recorder may not have received its samples.
/// @param next  the tick after `tick`; null: not recorded
[[nodiscard]] bool has_supervisor_stepped(const RecordedTick& tick, const RecordedTick* next);

/// @param next            the tick after `tick`; null: not recorded
/// @param period_ns       control period
/// @param missing_demand  SupervisorStatus.missing_demand_count before this tick; nothing: unknown
[[nodiscard]] Steps steps_of(const RecordedTick& tick, const RecordedTick* next, std::int64_t period_ns,
                             std::optional<std::uint64_t> missing_demand);

/// Describes what a stack in lockstep cannot repeat: "no crane/demand: a process was late". Empty: nothing.
[[nodiscard]] std::string irregularity(const Steps& steps);

}  // namespace crane::replay
