#include "replay/prescribed_stack.hpp"

#include <algorithm>
#include <initializer_list>

#include "replay/difference.hpp"

namespace crane::replay {
namespace {

constexpr int kPlanners = 8;  // the recorded reference decides in at most kPlanners - 1 ticks

bool is_recorded(const std::vector<Received>& replayed, const Cdr& recorded) {
  const auto& topic = topics::reference.description;
  const auto header = header_of(recorded);
  return std::ranges::any_of(replayed, [&](const Received& one) {
    return header && tick_of(one.cdr) == header->tick &&
           !first_difference(topic, recorded, with_epoch(topic, one.cdr, header->epoch));
  });
}

}  // namespace

PrescribedStack::PrescribedStack(std::span<const runtime::ComponentSpec> components,
                                 const configuration::Rig& rig, const control::Controller& controller)
    : corrects_reference_{controller.corrects_reference} {
  for (const auto& spec : components) {
    if (spec.source != crane_SOURCE_PLANNER) {
      components_.try_emplace(spec.source, spec, rig, controller);
      continue;
    }
    for (int i = 0; i < kPlanners; ++i) planners_.emplace_back(spec, rig, controller);
  }
}

bool PrescribedStack::receive(const RecordedTick& tick) {
  const auto* state = tick.find(topics::state.description);
  const auto header = state == nullptr ? std::nullopt : header_of(*state);
  if (!header) return false;
  tick_ = tick.number;
  time_ns_ = header->sample_time_ns;
  complete_ = true;
  repeated_.clear();
  samples_[topics::state.description.name][tick_] = *state;
  if (tick.begins || tick.number == 0 || tick.steps.planner_begins) begin_planner(tick);
  step_laws(tick);
  if (tick.steps.supervisor) step_supervisor(tick);
  if (tick.steps.planner) step_planner(tick);
  for (const auto& step : tick.without_state) step_without_state(step);
  return complete_;
}

/// When the planner started before the recording, the recorded reference of the first tick follows from the
/// previous state.
void PrescribedStack::begin_planner(const RecordedTick& tick) {
  std::vector<Received> published;
  for (auto& planner : planners_) {
    deliver(planner, topics::state.description);
    planner.poll(time_ns_);
    published = planner.take();
  }
  (void)collect(std::move(published));
  const auto& reference = topics::reference.description;
  const auto* recorded = tick.find(reference);
  const auto* replayed = find(reference, tick_);
  const auto header = replayed == nullptr ? std::nullopt : header_of(*replayed);
  if (tick.begins && recorded != nullptr && header)
    samples_[reference.name][tick_] = with_epoch(reference, *recorded, header->epoch);
}

void PrescribedStack::step_laws(const RecordedTick& tick) {
  const auto& state = topics::state.description;
  const auto& reference = topics::reference.description;
  const auto& anti_swing = topics::anti_swing.description;
  const auto step = [&](crane_Source source, std::initializer_list<const topics::Description*> inputs) {
    auto& component = of(source);
    for (const auto* input : inputs) deliver(component, *input);
    component.poll(time_ns_);
    (void)collect(component);
  };
  if (tick.steps.anti_swing) step(crane_SOURCE_ANTI_SWING, {&state, &reference});
  if (tick.steps.tracking && corrects_reference_)
    step(crane_SOURCE_TRACKING, {&state, &reference, &anti_swing});
  else if (tick.steps.tracking)
    step(crane_SOURCE_TRACKING, {&state, &reference});
  if (tick.steps.friction) step(crane_SOURCE_FRICTION, {&state, &topics::tracking.description, &anti_swing});
}

void PrescribedStack::step_supervisor(const RecordedTick& tick) {
  auto& supervisor = of(crane_SOURCE_SUPERVISOR);
  for (const auto& input : tick.inputs) complete_ = supervisor.deliver(input) && complete_;
  if (tick.steps.supervisor_has_demand) deliver(supervisor, topics::demand.description);
  if (tick.steps.supervisor_has_reference) deliver(supervisor, topics::reference.description);
  deliver(supervisor, topics::state.description);
  stepped_ns_ = time_ns_ + tick.steps.supervisor_after_ns;
  poll_until_stepped(supervisor, time_ns_);
}

void PrescribedStack::step_without_state(const StepWithoutState& step) {
  auto& supervisor = of(crane_SOURCE_SUPERVISOR);
  for (const auto& input : step.inputs) complete_ = supervisor.deliver(input) && complete_;
  stepped_ns_ += step.after_ns;
  poll_until_stepped(supervisor, std::max(supervisor.wake_at_ns(), stepped_ns_));
}

void PrescribedStack::step_planner(const RecordedTick& tick) {
  const auto& steps = tick.steps;
  const bool begun = steps.planner_begins || tick.begins || tick.number == 0;
  bool has_status = steps.planner_has_status;
  auto published = step(planners_.front(), begun, has_status);
  auto next = std::next(planners_.begin());
  if (steps.planner_may_lack_status && tick.next_reference && next != planners_.end() &&
      !is_recorded(published, *tick.next_reference)) {
    has_status = false;
    published = step(*next++, begun, has_status);
    planners_.pop_front();
    ++decided_by_outputs_;
  }
  for (; next != planners_.end(); ++next) (void)step(*next, begun, has_status);
  (void)collect(std::move(published));
}

std::vector<Received> PrescribedStack::step(PrescribedComponent& planner, bool begun, bool has_status) {
  if (!begun) deliver(planner, topics::state.description);
  if (has_status) deliver(planner, topics::supervisor.description);
  planner.poll(time_ns_);
  auto published = planner.take();
  if (!published.empty()) return published;
  planner.poll(time_ns_);
  return planner.take();
}

void PrescribedStack::deliver(PrescribedComponent& component, const topics::Description& topic) {
  const auto* cdr = find(topic, tick_);
  complete_ = cdr != nullptr && component.deliver(topic, *cdr) && complete_;
}

void PrescribedStack::poll_until_stepped(PrescribedComponent& component, std::int64_t now_ns) {
  component.poll(now_ns);
  if (collect(component)) return;
  component.poll(now_ns);
  (void)collect(component);
}

bool PrescribedStack::collect(std::vector<Received> taken) {
  for (auto& sample : taken) {
    const auto tick = tick_of(sample.cdr).value_or(0);
    auto& of_topic = samples_[sample.topic->name];
    if (tick < tick_ || of_topic.contains(tick))
      repeated_.push_back(std::move(sample));
    else
      of_topic.emplace(tick, std::move(sample.cdr));
  }
  return !taken.empty();
}

const Cdr* PrescribedStack::find(const topics::Description& topic, std::uint64_t tick) const {
  const auto of_topic = samples_.find(topic.name);
  if (of_topic == samples_.end()) return nullptr;
  const auto found = of_topic->second.find(tick);
  return found == of_topic->second.end() ? nullptr : &found->second;
}

void PrescribedStack::forget_until(std::uint64_t tick) {
  for (auto& [topic, samples] : samples_) samples.erase(samples.begin(), samples.upper_bound(tick));
}

}  // namespace crane::replay
