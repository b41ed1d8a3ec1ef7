#include "replay/arrival_order.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace crane::replay {
namespace {

/// Samples of tick k may arrive until the state of tick k + kLate_ticks: the history depth of a loop topic.
constexpr std::uint64_t kLate_ticks = 128;
constexpr auto kBegin_ns = std::numeric_limits<std::int64_t>::min();
constexpr auto kEnd_ns = std::numeric_limits<std::int64_t>::max();

/// True after ticks without recorded samples, when the reference follows from the state of one of these
/// ticks, or the bridge applies the command of one of them: the recorder has missed these samples.
bool answers_unknown_state(const RecordedTick& tick, std::uint64_t last_known) {
  const auto* cdr = tick.find(topics::state.description);
  const auto* reference = tick.find(topics::reference.description);
  const auto state = cdr == nullptr ? std::nullopt : decoded(topics::state, *cdr);
  if (!state) return false;
  const auto planned = reference == nullptr ? std::nullopt : header_of(*reference);
  return state->applied_command_tick > last_known ||
         (planned && planned->sample_time_ns != state->header.sample_time_ns);
}

}  // namespace

ArrivalOrder::ArrivalOrder(recording::McapReader& reader) : reader_{reader} {
  recording::Selection selection;
  for (const auto* topic :
       {&topics::accepted_request.description, &topics::accepted_jog.description, &topics::node.description})
    selection.topics.emplace_back(topic->name);
  reader_.for_each(selection, [this](const recording::Message& message) {
    note(message);
    return true;
  });
}

void ArrivalOrder::note(const recording::Message& message) {
  const auto& topic = message.channel->topic;
  if (topic == topics::accepted_request.description.name) {
    const auto accepted = decoded(topics::accepted_request, message.data);
    if (accepted && accepted->header.source == crane_SOURCE_SUPERVISOR)
      accepted_[accepted->header.tick].push_back({message.publish_time_ns, accepted->request});
  } else if (topic == topics::accepted_jog.description.name) {
    const auto accepted = decoded(topics::accepted_jog, message.data);
    if (accepted && accepted->header.source == crane_SOURCE_SUPERVISOR)
      jogs_[accepted->header.tick].push_back(accepted->jog);
  } else if (const auto node = decoded(topics::node, message.data); node && controller_.empty()) {
    controller_ = node->controller;
  }
}

void ArrivalOrder::for_each(std::int64_t period_ns, const std::function<bool(const RecordedTick&)>& visit) {
  period_ns_ = period_ns;
  ticks_.clear();
  epochs_.clear();
  before_.reset();
  last_state_.reset();
  missing_demand_ = 0;
  assumed_ = 0;
  has_earlier_ = false;
  bool begins = true;
  std::uint64_t newest = 0;  // tick with a state
  bool goes_on = true;
  const auto visit_first = [&] {
    auto first = ticks_.extract(ticks_.begin());
    auto& tick = first.mapped().tick;
    // The processes discover the bridge in any order. The stack is complete when the supervisor steps.
    if (begins && !has_supervisor_stepped(tick, after(tick.number))) {
      has_earlier_ = has_earlier_ || tick.find(topics::state.description) != nullptr;
      return;
    }
    complete(first.mapped());
    goes_on = !std::exchange(begins, false) || begin(tick, visit);
    goes_on = goes_on && visit(tick) && tick.ends.empty();
  };
  reader_.for_each({}, [&](const recording::Message& message) {
    const auto* topic = topic_named(message.channel->topic);
    if (topic == nullptr || !topic->every_tick) return true;
    gather(message, *topic);
    if (topic->name == topics::state.description.name)
      newest = std::max(newest, tick_of(message.data).value_or(0));
    while (goes_on && !ticks_.empty() && ticks_.begin()->first + kLate_ticks < newest) visit_first();
    return goes_on;
  });
  // The last tick has a reference but no state: the recording ends before it.
  while (goes_on && !ticks_.empty() && ticks_.begin()->first <= newest) visit_first();
  ticks_.clear();
}

/// The recorder may discover the bridge after the first ticks of the bridge. A supervisor that has not
/// finished its self-test shows that the stack has just started, with closed brakes and 0 V. A planner that
/// starts in this tick publishes the reference from the state of this tick; a planner that ran before
/// published it from the previous state.
bool ArrivalOrder::begin(RecordedTick& first, const std::function<bool(const RecordedTick&)>& visit) {
  constexpr std::uint64_t kMost_ticks = 100;
  const auto* cdr = first.find(topics::state.description);
  auto state = cdr == nullptr ? std::nullopt : decoded(topics::state, *cdr);
  const auto status = before_ ? before_ : next_status();
  const bool starts = status && status->state <= crane_STATE_SELFTEST;
  if (!state || !starts || first.number > kMost_ticks) return true;
  const auto time_ns = state->header.sample_time_ns;
  const auto* reference = first.find(topics::reference.description);
  const auto planned = reference == nullptr ? std::nullopt : header_of(*reference);
  first.begins = has_earlier_ || (planned && planned->sample_time_ns == time_ns);
  if (first.begins) return true;
  for (std::uint64_t tick = 0; tick < first.number; ++tick) {
    state->header.tick = tick;
    state->header.sample_time_ns = time_ns - static_cast<std::int64_t>(first.number - tick) * period_ns_;
    RecordedTick assumed{.number = tick, .assumed = true};
    assumed.steps.planner_begins = tick == 0;
    assumed.samples.emplace(topics::state.description.name, published(topics::state, *state));
    ++assumed_;
    if (!visit(assumed)) return false;
  }
  return true;
}

const RecordedTick* ArrivalOrder::after(std::uint64_t number) const {
  const auto found = ticks_.find(number + 1);
  return found == ticks_.end() ? nullptr : &found->second.tick;
}

/// A reader of another vendor may not receive the first sample of the supervisor.
std::optional<msg::SupervisorStatus> ArrivalOrder::next_status() const {
  for (const auto& [number, gathered] : ticks_)
    if (const auto* cdr = gathered.tick.find(topics::supervisor.description))
      return decoded(topics::supervisor, *cdr);
  return std::nullopt;
}

void ArrivalOrder::gather(const recording::Message& message, const topics::Description& topic) {
  const auto header = header_of(message.data);
  if (!header) return;
  auto& gathered = ticks_[header->tick];
  auto& tick = gathered.tick;
  tick.number = header->tick;
  const std::string name{topic.name};
  if (epochs_.try_emplace(topic.name, header->epoch).first->second != header->epoch)
    tick.ends = name + " has another start-up number: its process was restarted";
  Cdr cdr{message.data.begin(), message.data.end()};
  if (tick.find(topic) == nullptr) {
    tick.samples.emplace(topic.name, std::move(cdr));
    tick.published_ns.emplace(topic.name, message.publish_time_ns);
  } else if (topic.name == topics::supervisor.description.name) {
    gathered.more_statuses.push_back({message.publish_time_ns, std::move(cdr)});
  } else if (topic.name == topics::command.description.name) {
    gathered.more_commands.push_back({message.publish_time_ns, std::move(cdr)});
  } else {
    tick.ends = "two samples of " + name;
  }
}

void ArrivalOrder::complete(Gathered& gathered) {
  auto& tick = gathered.tick;
  describe(tick);
  const auto* cdr = tick.find(topics::supervisor.description);
  const auto status = cdr == nullptr ? std::nullopt : decoded(topics::supervisor, *cdr);
  if (!status) {
    if (tick.steps.supervisor) missing_demand_.reset();
    return;
  }
  const auto decided_ns = tick.published_ns.at(topics::supervisor.description.name);
  const bool last = gathered.more_statuses.empty();
  add_requests(tick.number, {kBegin_ns, last ? kEnd_ns : decided_ns}, tick.inputs);
  add_jogs(tick);
  before_ = status;
  add_steps_without_state(gathered);
  missing_demand_ = before_->missing_demand_count;
}

/// Without a state, and without samples that answer it, the bridge has skipped the tick. The reference of the
/// tick was published in the tick before.
void ArrivalOrder::describe(RecordedTick& tick) {
  if (tick.find(topics::state.description) == nullptr) {
    const auto answers = tick.samples.size() - tick.samples.count(topics::reference.description.name);
    tick.steps = {
        .planner = false, .tracking = false, .anti_swing = false, .friction = false, .supervisor = false};
    if (answers > 0)
      tick.ends =
          "no " + std::string{topics::state.description.name} + ": the recorder did not receive the sample";
    tick.irregular = "no " + std::string{topics::state.description.name} + ": the bridge skipped the tick";
    return;
  }
  if (last_state_ && tick.number > *last_state_ + 1 && answers_unknown_state(tick, *last_state_))
    tick.ends = "the recorder did not receive the samples of the tick before";
  last_state_ = tick.number;
  const auto* next = after(tick.number);
  tick.steps = steps_of(tick, next, period_ns_, missing_demand_);
  if (next != nullptr)
    if (const auto* reference = next->find(topics::reference.description)) tick.next_reference = *reference;
  auto regular = tick.steps;
  if (tick.number == 0) regular.planner_begins = false;  // there is no tick before
  tick.irregular = irregularity(regular);
}

void ArrivalOrder::add_steps_without_state(Gathered& gathered) {
  auto& tick = gathered.tick;
  auto& statuses = gathered.more_statuses;
  const bool all_commands = gathered.more_commands.size() == statuses.size();
  auto before_ns = tick.published_ns.at(topics::supervisor.description.name);
  for (std::size_t i = 0; i < statuses.size(); ++i) {
    const auto status = decoded(topics::supervisor, statuses[i].cdr);
    if (!status) continue;
    StepWithoutState step;
    const auto sent_ns = statuses[i].sent_ns;
    add_requests(tick.number, {before_ns, i + 1 == statuses.size() ? kEnd_ns : sent_ns}, step.inputs);
    step.after_ns = sent_ns - std::exchange(before_ns, sent_ns);
    if (all_commands) step.command = std::move(gathered.more_commands[i].cdr);
    step.status = std::move(statuses[i].cdr);
    tick.without_state.push_back(std::move(step));
    before_ = status;
  }
  if (!statuses.empty()) tick.irregular = "the supervisor stepped without a new state";
}

void ArrivalOrder::add_requests(std::uint64_t tick, const Between& times, std::vector<Received>& inputs) {
  const auto accepted = accepted_.find(tick);
  if (accepted == accepted_.end()) return;
  for (const auto& [sent_ns, request] : accepted->second) {
    if (sent_ns <= times.after_ns || sent_ns > times.until_ns) continue;
    inputs.push_back({&topics::request.description, published(topics::request, request)});
  }
}

/// The supervisor takes samples of the stick only in a step with a state.
void ArrivalOrder::add_jogs(RecordedTick& tick) const {
  const auto jogs = jogs_.find(tick.number);
  if (jogs == jogs_.end()) return;
  for (const auto& jog : jogs->second)
    tick.inputs.push_back({&topics::jog.description, published(topics::jog, jog)});
}

}  // namespace crane::replay
