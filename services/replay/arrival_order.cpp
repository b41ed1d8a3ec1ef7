#include "replay/arrival_order.hpp"

#include <algorithm>
#include <utility>

#include "replay/lost_request.hpp"

namespace crane::replay {
namespace {

/// Ticks by which samples of one tick may arrive later than the state of a later tick: the history of a loop
/// topic.
constexpr std::uint64_t kLate_ticks = 128;
/// Time from the publication of a sample of crane/jog until the supervisor has certainly received it.
constexpr std::int64_t kArrival_ns = 1'000'000;

/// The status shows this deflection of the stick. In maintenance, the supervisor reduces it.
bool shows(const msg::SupervisorStatus& status, const msg::Jog& jog) {
  for (std::size_t i = 0; i < std::size(jog.deflection); ++i) {
    const double sent = jog.engaged ? jog.deflection[i] : 0, shown = status.jog_deflection[i];
    const bool same = status.mode == crane_MODE_MAINTENANCE ? (sent == 0) == (shown == 0) : sent == shown;
    if (!same) return false;
  }
  return true;
}

}  // namespace

ArrivalOrder::ArrivalOrder(recording::McapReader& reader) : reader_{reader} {
  recording::Selection selection;
  for (const auto* topic : {&topics::request.description, &topics::reply.description,
                            &topics::jog.description, &topics::node.description})
    selection.topics.emplace_back(topic->name);
  reader_.for_each(selection, [this](const recording::Message& message) {
    note(message);
    return true;
  });
  std::ranges::stable_sort(jogs_, {}, &Jog::sent_ns);
}

void ArrivalOrder::note(const recording::Message& message) {
  const auto& topic = message.channel->topic;
  Cdr cdr{message.data.begin(), message.data.end()};
  if (topic == topics::request.description.name) {
    if (const auto request = decoded(topics::request, cdr))
      requests_.try_emplace({request->client, request->id}, std::move(cdr));
  } else if (topic == topics::reply.description.name) {
    const auto reply = decoded(topics::reply, cdr);
    if (reply && reply->header.source == crane_SOURCE_SUPERVISOR)
      replies_[reply->header.tick].push_back(*reply);
  } else if (topic == topics::jog.description.name) {
    if (const auto jog = decoded(topics::jog, cdr))
      jogs_.push_back({message.publish_time_ns, *jog, std::move(cdr)});
  } else if (const auto node = decoded(topics::node, cdr); node && controller_.empty()) {
    controller_ = node->controller;
  }
}

void ArrivalOrder::for_each(std::int64_t period_ns, const std::function<bool(const RecordedTick&)>& visit) {
  period_ns_ = period_ns;
  ticks_.clear();
  epochs_.clear();
  before_.reset();
  derived_.clear();
  next_jog_ = 0;
  assumed_ = 0;
  has_earlier_ = false;
  bool begins = true;
  std::uint64_t newest = 0;  // tick with a state
  bool goes_on = true;
  const auto visit_first = [&] {
    auto first = ticks_.extract(ticks_.begin());
    auto& tick = first.mapped().tick;
    // The processes discover the bridge one after the other; the supervisor completes the stack.
    if (begins && tick.find(topics::state.description) != nullptr &&
        tick.find(topics::supervisor.description) == nullptr) {
      has_earlier_ = true;
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
  // The reference of the next tick has no state: the recording ends.
  while (goes_on && !ticks_.empty() && ticks_.begin()->first <= newest) visit_first();
  ticks_.clear();
}

/// The recorder may discover the bridge after its first ticks. A supervisor that has not finished its
/// self-test shows that the stack has just started, with closed brakes and 0 V. A planner that begins with
/// this tick publishes its reference from the state of this tick, otherwise from the state before it.
bool ArrivalOrder::begin(RecordedTick& first, const std::function<bool(const RecordedTick&)>& visit) {
  constexpr std::uint64_t kMost_ticks = 100;
  const auto* cdr = first.find(topics::state.description);
  auto state = cdr == nullptr ? std::nullopt : decoded(topics::state, *cdr);
  const bool starts = before_ && before_->state <= crane_STATE_SELFTEST;
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
    assumed.samples.emplace(topics::state.description.name, published(topics::state, *state));
    ++assumed_;
    if (!visit(assumed)) return false;
  }
  return true;
}

void ArrivalOrder::gather(const recording::Message& message, const topics::Description& topic) {
  const auto header = header_of(message.data);
  if (!header) return;
  auto& gathered = ticks_[header->tick];
  auto& tick = gathered.tick;
  tick.number = header->tick;
  const std::string name{topic.name};
  if (!tick.samples.try_emplace(topic.name, message.data.begin(), message.data.end()).second)
    tick.ends = "two samples of " + name + ": a process stepped without a new state";
  if (epochs_.try_emplace(topic.name, header->epoch).first->second != header->epoch)
    tick.ends = name + " has another start-up number: its process was restarted";
  if (topic.name == topics::supervisor.description.name) gathered.decided_ns = message.publish_time_ns;
}

void ArrivalOrder::complete(Gathered& gathered) {
  auto& tick = gathered.tick;
  if (tick.find(topics::state.description) == nullptr)
    tick.ends = "no " + std::string{topics::state.description.name} +
                ": the bridge skipped the tick, or the recorder did not receive the sample";
  const auto* cdr = tick.find(topics::supervisor.description);
  const auto status = cdr == nullptr ? std::nullopt : decoded(topics::supervisor, *cdr);
  if (!status) return;
  add_requests(tick, *status);
  add_jogs(gathered, *status);
  before_ = status;
}

void ArrivalOrder::add_requests(RecordedTick& tick, const msg::SupervisorStatus& status) {
  const auto replies = replies_.find(tick.number);
  if (replies == replies_.end()) return;
  for (const auto& reply : replies->second) {
    if (const auto found = requests_.find({reply.client, reply.request_id}); found != requests_.end()) {
      tick.inputs.push_back({&topics::request.description, found->second});
    } else if (reply.accepted && before_) {
      auto request = request_behind(reply, *before_, status);
      if (!request) continue;
      const auto jog = std::ranges::find_if(
          jogs_, [&](const Jog& one) { return one.sample.request_id == reply.request_id; });
      if (jog != jogs_.end()) request->header.epoch = jog->sample.header.epoch;
      tick.inputs.push_back({&topics::request.description, published(topics::request, *request)});
      derived_.push_back("tick " + std::to_string(tick.number) + ": " + in_words(*request));
    }
  }
}

/// The supervisor has received the samples that were published kArrival_ns before its decision. Its status
/// shows whether it has also received those after them.
void ArrivalOrder::add_jogs(Gathered& gathered, const msg::SupervisorStatus& status) {
  const auto deliver_until = [&](std::size_t end) {
    for (; next_jog_ < end; ++next_jog_)
      gathered.tick.inputs.push_back({&topics::jog.description, jogs_[next_jog_].cdr});
  };
  const auto sent_until = [&](std::int64_t time_ns) {
    return static_cast<std::size_t>(std::ranges::upper_bound(jogs_, time_ns, {}, &Jog::sent_ns) -
                                    jogs_.begin());
  };
  deliver_until(sent_until(gathered.decided_ns - kArrival_ns));
  const auto possible = sent_until(gathered.decided_ns);
  if (next_jog_ > 0 && shows(status, jogs_[next_jog_ - 1].sample)) return;
  for (auto end = next_jog_ + 1; end <= possible; ++end)
    if (shows(status, jogs_[end - 1].sample)) return deliver_until(end);
}

}  // namespace crane::replay
