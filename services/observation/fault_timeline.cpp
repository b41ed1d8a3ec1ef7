#include "observation/fault_timeline.hpp"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <ranges>
#include <span>

#include "crane/bridge/last_line.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::observation {
namespace {

using nlohmann::ordered_json;

Note::Kind kind_of(crane_Cause cause) {
  switch (cause) {
    case crane_CAUSE_OPERATOR_STOP:
    case crane_CAUSE_OPERATOR_DISARM:
    case crane_CAUSE_OPERATOR_ESTOP:
    case crane_CAUSE_IDLE:
    case crane_CAUSE_HOMED:
      return Note::Kind::order;
    default:
      return Note::Kind::fault;
  }
}

const char* name_of(Note::Kind kind) {
  constexpr std::array kNames{"order", "warning", "fault"};
  return kNames[static_cast<std::size_t>(kind)];
}

ordered_json json_of(const Note& note) {
  return {{"at_ns", std::to_string(note.at_ns)},  // as text, because a number of JavaScript has fewer digits
          {"tick", note.tick},
          {"kind", name_of(note.kind)},
          {"from", note.from},
          {"what", note.what},
          {"explanation", note.explanation},
          {"remedy", note.remedy}};
}

bool works(crane_SupervisorState state) {
  return state == crane_STATE_READY || state == crane_STATE_ARMING || state == crane_STATE_HOLD ||
         state == crane_STATE_RUN;
}

}  // namespace

bool is_operator_stop(const Note& note) {
  return note.kind == Note::Kind::order && (note.what == "OPERATOR_STOP" || note.what == "OPERATOR_ESTOP");
}

void FaultTimeline::add(const Sample& sample) {
  if (msg::SupervisorStatus status; decode(topics::supervisor, sample, status))
    add_status(sample, status);
  else if (msg::State state; decode(topics::state, sample, state))
    add_state(sample, state);
  else if (msg::Event event; decode(topics::event, sample, event))
    add_event(sample, event);
}

void FaultTimeline::add_status(const Sample& sample, const msg::SupervisorStatus& status) {
  if (works(status.state) && !faults_.empty() && faults_.back().cleared_ns == 0) {
    faults_.back().cleared_ns = sample.log_time_ns;
    changed_ = true;
  }
  if (status.cause == cause_) return;
  const bool earlier = !cause_;
  cause_ = status.cause;
  if (status.cause == crane_CAUSE_NONE || status.cause == crane_CAUSE_START) return;
  const auto cause = static_cast<supervisor::Cause>(status.cause);
  const std::string state = supervisor::name_of(static_cast<supervisor::State>(status.state));
  put({.at_ns = sample.log_time_ns,
       .tick = sample.header.tick,
       .kind = kind_of(status.cause),
       .from = "supervisor",
       .what = supervisor::name_of(cause),
       .explanation = (earlier ? "the supervisor was in " : "the supervisor went to ") + state,
       .remedy = supervisor::remedy_for(cause),
       .key = "supervisor/supervisor_state",
       .earlier = earlier});
}

void FaultTimeline::add_state(const Sample& sample, const msg::State& state) {
  if (state.latch_reason == latch_) return;
  const bool earlier = !latch_;
  latch_ = state.latch_reason;
  if (state.latch_reason == crane_LATCH_NONE) return;
  const auto reason = static_cast<bridge::Reason>(state.latch_reason);
  const std::string bridge = source_name(sample.header.source), name{bridge::name_of(reason)};
  // The supervisor withdraws the watchdog permission after every stop. Missing commands are then not a fault.
  put({.at_ns = sample.log_time_ns,
       .tick = sample.header.tick,
       .kind = Note::Kind::fault,
       .from = bridge,
       .what = "LATCH_" + name,
       .explanation = std::string{bridge::explanation_of(reason)},
       .remedy = std::string{bridge::remedy_for(reason)},
       .key = bridge + "/" + name,
       .earlier = earlier});
}

void FaultTimeline::add_event(const Sample& sample, const msg::Event& event) {
  if (event.severity == crane_SEVERITY_INFO) return;
  const auto kind = event.severity == crane_SEVERITY_ERROR ? Note::Kind::fault : Note::Kind::warning;
  // An event may be older than the dashboard, because its writer stores the last 64 events for readers that
  // join later. The time of a new event is its time of arrival, as for the samples of all other topics,
  // because the clock of another host may differ slightly.
  constexpr std::int64_t kLive_ns = 2'000'000'000;
  // `crane up` checks every 50 ms whether its processes run. The correction places the end of a process
  // before the stop that follows from it.
  constexpr std::int64_t kNoticed_ns = 60'000'000;
  const std::int64_t earlier_ns = std::string_view{event.code} == "process_ended" ? kNoticed_ns : 0;
  const bool live = std::abs(sample.log_time_ns - sample.source_time_ns) < kLive_ns;
  put({.at_ns = (live ? sample.log_time_ns : sample.source_time_ns) - earlier_ns,
       .tick = event.header.tick,
       .kind = kind,
       .from = event.node,
       .what = event.code,
       .explanation = event.what,
       .remedy = event.remedy,
       .key = std::string{event.node} + "/" + event.code,
       .event = true});
}

void FaultTimeline::put(Note note) {
  changed_ = true;
  auto joined = std::ranges::find_if(faults_, [&](const Fault& fault) {
    return note.at_ns >= fault.notes.front().at_ns - kQuiet_ns && note.at_ns <= fault.last_ns + kQuiet_ns;
  });
  if (joined == faults_.end()) {
    if (faults_.size() == kMostFaults) faults_.pop_front();
    const auto later = std::ranges::upper_bound(faults_, note.at_ns, {}, &Fault::last_ns);
    const auto at_ns = note.at_ns;
    faults_.insert(later, Fault{.number = next_number_++,
                                .notes = {std::move(note)},
                                .last_ns = at_ns,
                                .surrounding_samples = {}});
    return;
  }
  if (merge(*joined, note)) return;
  const bool repeated = std::ranges::any_of(joined->notes, [&](const Note& other) {
    return other.from == note.from && other.what == note.what && other.explanation == note.explanation;
  });
  joined->last_ns = std::max(joined->last_ns, note.at_ns);
  if (repeated || joined->notes.size() >= kMostNotes) {
    ++joined->left_out;
    return;
  }
  const auto later = std::ranges::upper_bound(joined->notes, note.at_ns, {}, &Note::at_ns);
  joined->notes.insert(later, std::move(note));
}

bool FaultTimeline::merge(Fault& fault, const Note& note) {
  constexpr std::int64_t kSame_ns = 1'000'000'000;
  const auto found = std::ranges::find_if(fault.notes, [&](const Note& other) {
    return !other.announced && other.event != note.event && !note.key.empty() && other.key == note.key &&
           std::abs(other.at_ns - note.at_ns) < kSame_ns;
  });
  if (found == fault.notes.end()) return false;
  const auto at_ns = std::min(found->at_ns, note.at_ns);
  if (found->event) *found = note;  // keeps the content of the topic; the event may have the earlier time
  found->at_ns = at_ns;
  found->announced = true;
  std::ranges::stable_sort(fault.notes, {}, &Note::at_ns);
  return true;
}

bool FaultTimeline::poll(std::int64_t now_ns, std::int64_t log_now_ns, const Traffic& traffic,
                         const History& history) {
  notice_silence(now_ns, traffic);
  store_surrounding_samples(log_now_ns, history);
  return std::exchange(changed_, false);
}

void FaultTimeline::notice_silence(std::int64_t now_ns, const Traffic& traffic) {
  for (const auto& [number, heard] : traffic.nodes()) {
    const bool silent = heard.silent(now_ns);
    if (silent == std::exchange(silent_[number], silent) || !silent) continue;
    const bool orderly = heard.status.phase == crane_PHASE_STOPPING;
    put({.at_ns = heard.log_time_ns,
         .tick = heard.status.header.tick,
         .kind = orderly ? Note::Kind::warning : Note::Kind::fault,
         .from = heard.status.name,
         .what = "process_silent",
         .explanation = orderly ? "the process has ended" : "the last sample of the process arrived here",
         .remedy = "read the output of `crane up`, then restart the process"});
  }
}

void FaultTimeline::store_surrounding_samples(std::int64_t log_now_ns, const History& history) {
  for (auto& fault : faults_) {
    const auto at_ns = fault.notes.front().at_ns;
    if (fault.samples_stored || log_now_ns < at_ns + kAfter_ns || log_now_ns > at_ns + History::kLongest_ns)
      continue;
    for (std::size_t i = 0; i < topics::kAll.size(); ++i)
      if (topics::kAll[i].every_tick)
        fault.surrounding_samples[i] = history.between(i, at_ns - kBefore_ns, at_ns + kAfter_ns);
    fault.samples_stored = true;
    changed_ = true;
  }
  std::size_t kept = 0;
  for (auto& fault : std::views::reverse(faults_))
    if (!fault.surrounding_samples.empty() && ++kept > kMostFaultsWithSamples)
      fault.surrounding_samples.clear();
}

const Fault* FaultTimeline::find(std::uint64_t number) const {
  const auto found = std::ranges::find(faults_, number, &Fault::number);
  return found == faults_.end() ? nullptr : &*found;
}

ordered_json FaultTimeline::json() const {
  auto list = ordered_json::array();
  for (const auto& fault : std::views::reverse(faults_)) {
    ordered_json line{{"number", fault.number},
                      {"first", json_of(fault.notes.front())},
                      {"consequences", ordered_json::array()},
                      {"left_out", fault.left_out},
                      {"cleared_ns", fault.cleared_ns == 0 ? ordered_json(nullptr)
                                                           : ordered_json(std::to_string(fault.cleared_ns))},
                      {"has_data", !fault.surrounding_samples.empty()}};
    for (const auto& note : std::span{fault.notes}.subspan(1)) line["consequences"].push_back(json_of(note));
    list.push_back(std::move(line));
  }
  return {{"faults", list}};
}

}  // namespace crane::observation
