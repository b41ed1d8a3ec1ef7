#include "replay/steps.hpp"

#include <algorithm>

#include "replay/recorded_tick.hpp"

namespace crane::replay {
namespace {

template <class T>
std::optional<T> sample_of(const topics::Topic<T>& topic, const RecordedTick& tick) {
  const auto* cdr = tick.find(topic.description);
  return cdr == nullptr ? std::nullopt : decoded(topic, *cdr);
}

bool has(const RecordedTick& tick, const topics::Description& topic) { return tick.find(topic) != nullptr; }

struct Published {
  const RecordedTick& tick;
  const topics::Description& topic;
  [[nodiscard]] std::optional<std::int64_t> time_ns() const {
    const auto found = tick.published_ns.find(topic.name);
    return found == tick.published_ns.end() ? std::nullopt : std::optional{found->second};
  }
};

/// @return nothing when one of both times is unknown
std::optional<std::int64_t> between_ns(const Published& first, const Published& second) {
  const auto from_ns = first.time_ns(), until_ns = second.time_ns();
  return from_ns && until_ns ? std::optional{*until_ns - *from_ns} : std::nullopt;
}

/// True when a control law stepped: it then had the reference of the tick.
bool used_reference(const RecordedTick& tick) {
  return has(tick, topics::tracking.description) || has(tick, topics::anti_swing.description) ||
         has(tick, topics::demand.description);
}

/// True when the bridge applied the command of tick k, as it does in tick k + 1.
bool is_applied(const RecordedTick& tick, const RecordedTick* next) {
  const auto state = next == nullptr ? std::nullopt : sample_of(topics::state, *next);
  return state && tick.number > 0 && state->applied_command_tick == tick.number;
}

std::int64_t sample_time_ns(const RecordedTick& tick, const topics::Description& topic) {
  const auto* cdr = tick.find(topic);
  const auto header = cdr == nullptr ? std::nullopt : header_of(*cdr);
  return header ? header->sample_time_ns : 0;
}

void decide_planner(const RecordedTick& tick, const RecordedTick* next, std::int64_t period_ns,
                    Steps& steps) {
  const auto& reference = topics::reference.description;
  const auto state_ns = sample_time_ns(tick, topics::state.description);
  steps.planner_begins = has(tick, reference) && sample_time_ns(tick, reference) == state_ns;
  const auto is_from_here = [&] { return sample_time_ns(*next, reference) == state_ns; };
  steps.planner = next != nullptr && (has(*next, reference) ? is_from_here() : used_reference(*next));
  if (!steps.planner) return;
  const Published planned{*next, reference};
  steps.planner_has_status =
      steps.supervisor && between_ns({tick, topics::supervisor.description}, planned).value_or(0) >= 0;
  // A planner that receives the status publishes its reference at once.
  steps.planner_may_lack_status =
      steps.planner_has_status &&
      between_ns({tick, topics::state.description}, planned).value_or(0) > period_ns / 2;
}

void decide_supervisor(const RecordedTick& tick, const RecordedTick* next,
                       std::optional<std::uint64_t> missing_demand, Steps& steps) {
  const auto status = sample_of(topics::supervisor, tick);
  steps.supervisor = has_supervisor_stepped(tick, next);
  // The count starts at 0: a supervisor with a count of 0 had the demand of every tick.
  const auto before =
      status && status->missing_demand_count == 0 ? std::optional<std::uint64_t>{0} : missing_demand;
  steps.supervisor_has_demand = status && before ? status->missing_demand_count == *before : steps.friction;
  steps.friction = steps.friction || (steps.supervisor && steps.supervisor_has_demand);
  const auto& reference = topics::reference.description;
  const Published decided{tick, topics::supervisor.description};
  steps.supervisor_has_reference = (has(tick, reference) || used_reference(tick)) &&
                                   between_ns({tick, reference}, decided).value_or(0) >= 0;
  steps.supervisor_after_ns =
      std::max<std::int64_t>(0, between_ns({tick, topics::state.description}, decided).value_or(0));
}

}  // namespace

bool has_supervisor_stepped(const RecordedTick& tick, const RecordedTick* next) {
  return has(tick, topics::supervisor.description) || has(tick, topics::command.description) ||
         is_applied(tick, next);
}

Steps steps_of(const RecordedTick& tick, const RecordedTick* next, std::int64_t period_ns,
               std::optional<std::uint64_t> missing_demand) {
  Steps steps;
  steps.friction = has(tick, topics::demand.description);
  decide_supervisor(tick, next, missing_demand, steps);
  decide_planner(tick, next, period_ns, steps);
  steps.tracking = steps.friction || has(tick, topics::tracking.description);
  steps.anti_swing = steps.friction || has(tick, topics::anti_swing.description);
  return steps;
}

std::string irregularity(const Steps& steps) {
  std::string text;
  const auto note = [&](bool irregular, const char* what) {
    if (irregular) text += (text.empty() ? "" : ", ") + std::string{what};
  };
  note(steps.planner_begins, "no crane/reference from the tick before");
  note(!steps.tracking, "no crane/tracking");
  note(!steps.anti_swing, "no crane/anti_swing");
  note(!steps.friction, "no crane/demand");
  note(!steps.supervisor, "no crane/command");
  note(!steps.planner, "no crane/reference of the next tick");
  note(steps.supervisor && !steps.supervisor_has_demand, "the supervisor did not wait for crane/demand");
  note(steps.supervisor && !steps.supervisor_has_reference,
       "the supervisor did not wait for crane/reference");
  note(steps.supervisor && steps.planner && !steps.planner_has_status,
       "the planner did not wait for crane/supervisor");
  return text.empty() ? text : text + ": a process was late";
}

}  // namespace crane::replay
