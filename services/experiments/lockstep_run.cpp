#include "experiments/lockstep_run.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "crane/bus/seal.hpp"
#include "crane/runtime/process.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::experiments {
namespace {

using experiment::Scenario;
using TickSamples = runtime::TickJoin<msg::State, msg::Reference, msg::Contribution, msg::Contribution,
                                      msg::Demand, msg::Command, msg::SupervisorStatus>;

// Ticks per advance request: less than half the history depth of the loop topics (128).
constexpr std::uint64_t kChunk_ticks = 50;
constexpr runtime::JoinPolicy kEveryTick{.in_order = true, .depth = 256};
constexpr std::int64_t kTimeout_ns = 10'000'000'000;
constexpr double kLongestPreparation_s = 20;

TickSamples collect_from(bus::Bus& bus) {
  const auto input = runtime::loop_endpoint(runtime::Clock::lockstep);
  return TickSamples{kEveryTick,
                     runtime::loop_reader(bus, topics::state, input),
                     runtime::loop_reader(bus, topics::reference, input),
                     runtime::loop_reader(bus, topics::tracking, input),
                     runtime::loop_reader(bus, topics::anti_swing, input),
                     runtime::loop_reader(bus, topics::demand, input),
                     runtime::loop_reader(bus, topics::command, input),
                     runtime::loop_reader(bus, topics::supervisor, input)};
}

/// Topics whose samples are read as structs (TickSamples). Samples of all other loop topics are read as
/// bytes.
const std::array kCollected{&topics::state.description,     &topics::reference.description,
                            &topics::tracking.description,  &topics::anti_swing.description,
                            &topics::demand.description,    &topics::command.description,
                            &topics::supervisor.description};

/// Samples of one loop topic outside the control loop, for example crane/twin.
class OtherTopic {
 public:
  OtherTopic(bus::Bus& bus, const topics::Description& topic)
      : reader_{bus.cdr_subscriber(topic, runtime::loop_endpoint(runtime::Clock::lockstep))} {}

  /// @return the sample of the tick; nothing when it has not arrived yet
  [[nodiscard]] std::optional<OtherSample> find(std::uint64_t tick) {
    std::vector<std::uint8_t> cdr;
    while (const auto header = reader_.take(cdr)) samples_[header->tick] = cdr;
    const auto found = samples_.find(tick);
    if (found == samples_.end()) return std::nullopt;
    return OtherSample{&reader_.topic(), found->second};
  }
  void forget(std::uint64_t tick) { samples_.erase(samples_.begin(), samples_.upper_bound(tick)); }

 private:
  bus::CdrSubscriber reader_;
  std::map<std::uint64_t, std::vector<std::uint8_t>> samples_;
};

/// One reader for every loop topic that the components write and that is not collected.
std::vector<OtherTopic> other_topics(bus::Bus& bus, std::span<const runtime::ComponentSpec> components,
                                     const control::Design& design) {
  const auto is_written = [&](const topics::Description& topic) {
    return std::ranges::any_of(components, [&](const auto& component) {
      return std::ranges::any_of(component.writes, [&](const auto& write) {
        return write.topic->name == topic.name && runtime::is_written(write, design);
      });
    });
  };
  std::vector<OtherTopic> others;
  for (const auto& topic : topics::kAll)
    if (topic.every_tick && is_written(topic) &&
        std::ranges::none_of(kCollected, [&](const auto* known) { return known->name == topic.name; }))
      others.emplace_back(bus, topic);
  return others;
}

class LockstepRun {
 public:
  LockstepRun(bus::Bus& bus, const Pump& pump, const configuration::Rig& rig, const Scenario& scenario,
              TickLog& log, std::span<const runtime::ComponentSpec> components)
      : pump_{pump},
        rig_{rig},
        scenario_{scenario},
        log_{log},
        bus_{bus.options()},
        operator_{bus, "crane_run", 1},
        collected_{collect_from(bus)},
        others_{other_topics(bus, components, rig.design)} {}

  RunOutcome execute() {
    wait_until([this] { return operator_.listeners() >= kListeners && operator_.answerers() >= kListeners; },
               "the processes of the stack to listen");
    const auto begin_ns = runtime::monotonic_ns();
    prepare();
    outcome_.hold_tick = requested_tick_ + 1;
    schedule_actions();
    const auto end = outcome_.hold_tick + ticks(scenario_.end_s());
    while (requested_tick_ < end && !stopped()) advance_to(std::min(requested_tick_ + kChunk_ticks, end));
    check_verdicts();
    outcome_.completed = !stopped();
    if (stopped()) outcome_.stopped_because = supervisor::name_of(static_cast<supervisor::Cause>(cause_));
    outcome_.last_tick = requested_tick_;
    outcome_.wall_s = static_cast<double>(runtime::monotonic_ns() - begin_ns) * 1e-9;
    return outcome_;
  }

 private:
  static constexpr int kListeners = 2;  // plant, supervisor

  [[nodiscard]] std::uint64_t ticks(double time_s) const {
    return static_cast<std::uint64_t>(std::llround(time_s / rig_.period_s));
  }
  [[nodiscard]] bool stopped() const { return state_ >= crane_STATE_STOP_C1; }

  template <class Condition>
  void wait_until(Condition condition, const std::string& what) {
    auto deadline_ns = runtime::monotonic_ns() + kTimeout_ns;
    while (!condition()) {
      pump_();
      if (collect()) deadline_ns = runtime::monotonic_ns() + kTimeout_ns;
      operator_.receive();
      if (runtime::monotonic_ns() > deadline_ns)
        throw RunError("waited " + std::to_string(kTimeout_ns / 1'000'000'000) + " s for " + what);
      if (runtime::stop_requested()) throw RunError("interrupted");
    }
  }

  /// Takes the complete ticks. @return true when there was at least one
  bool collect() {
    bool any = false;
    while (others_arrived() && collected_.poll(0) == runtime::JoinResult::complete) {
      const Tick tick{collected_.get<0>(), collected_.get<1>(), collected_.get<2>(), collected_.get<3>(),
                      collected_.get<4>(), collected_.get<5>(), collected_.get<6>()};
      log_.add(tick, other_samples_);
      for (auto& other : others_) other.forget(collected_.tick());
      collected_tick_ = collected_.tick();
      clock_master_ = tick.state->header.source;
      if (!stopped()) cause_ = tick.supervisor->cause;
      if (!stopped()) state_ = tick.supervisor->state;
      any = true;
    }
    return any;
  }

  /// True when the samples of the observers, which publish after the loop, have arrived: the tick is
  /// complete.
  bool others_arrived() {
    other_samples_.clear();
    for (auto& other : others_) {
      const auto sample = other.find(collected_.next_tick());
      if (!sample) return false;
      other_samples_.push_back(*sample);
    }
    return true;
  }

  void advance_to(std::uint64_t tick) {
    operator_.send({.kind = crane_REQUEST_ADVANCE, .until_tick = tick});
    requested_tick_ = tick;
    wait_until([this, tick] { return collected_tick_ == tick; }, "tick " + std::to_string(tick));
  }

  void advance_by(std::uint64_t ticks) {
    for (const auto end = requested_tick_ + ticks; requested_tick_ < end;)
      advance_to(std::min(requested_tick_ + kChunk_ticks, end));
  }

  /// Waits for the self-test, resets and arms, so that the brakes open.
  void prepare() {
    const auto longest = ticks(kLongestPreparation_s);
    const auto wait_for_state = [&](std::initializer_list<crane_SupervisorState> wanted) {
      while (std::find(wanted.begin(), wanted.end(), state_) == wanted.end()) {
        if (requested_tick_ > longest)
          throw RunError(std::string{"the supervisor stays in "} +
                         supervisor::name_of(static_cast<supervisor::State>(state_)) + " because of " +
                         supervisor::name_of(static_cast<supervisor::Cause>(cause_)));
        advance_to(requested_tick_ + kChunk_ticks);
        check_verdicts();
      }
    };
    constexpr double kCausesClear_s = 1.1;  // a reset needs causes that have been inactive for a second
    advance_by(ticks(kCausesClear_s));
    wait_for_state({crane_STATE_LOCKED});
    request({.kind = crane_REQUEST_RESET}, crane_SOURCE_SUPERVISOR);
    advance_by(ticks(kCausesClear_s));
    wait_for_state({crane_STATE_READY});
    request({.kind = crane_REQUEST_ARM}, crane_SOURCE_SUPERVISOR);
    // With wind or a tilted jib, the anti-swing law moves the axes at once. The state can then be RUN without
    // a move.
    wait_for_state({crane_STATE_HOLD, crane_STATE_RUN});
    check_verdicts();
  }

  void schedule_actions() {
    for (const auto& move : scenario_.moves) {
      stack::OperatorRequest wanted{.kind = crane_REQUEST_MOVE};
      wanted.apply_tick = outcome_.hold_tick + ticks(move.at_s);
      for (std::size_t i = 0; i < wanted.target.size(); ++i) {
        wanted.selected[i] = move.target[i].has_value();
        wanted.target[i] = move.target[i].value_or(0);
      }
      request(wanted, crane_SOURCE_SUPERVISOR);
    }
    for (const auto& excitation : scenario_.excitations) {
      stack::OperatorRequest wanted = stack::request_to_follow(excitation.reference);
      wanted.apply_tick = outcome_.hold_tick + ticks(excitation.at_s);
      request(wanted, crane_SOURCE_SUPERVISOR);
    }
    for (const auto& kick : scenario_.kicks) {
      stack::OperatorRequest wanted{.kind = crane_REQUEST_KICK,
                                    .kick_radps = {kick.radial_radps, kick.tangential_radps}};
      wanted.apply_tick = outcome_.hold_tick + ticks(kick.at_s);
      request(wanted, clock_master_);
    }
  }

  /// Sends a request for an exact tick and waits until `decides` has confirmed it. `decides` accepts or
  /// refuses the request in its tick.
  void request(stack::OperatorRequest wanted, crane_Source decides) {
    wanted.apply_tick = std::max(wanted.apply_tick, requested_tick_ + 1);
    const auto id = operator_.send(wanted);
    auto sent = operator_.last_sent();
    bus::seal(topics::request.description, &sent, bus_.source, bus_.epoch, bus_.messages_version);
    log_.receive(topics::request, sent);
    wait_until([&] { return operator_.take_reply(id, decides, true).has_value(); },
               "a confirmation of a request");
    verdicts_.push_back({id, decides, wanted.apply_tick});
  }

  /// Checks the replies to the requests whose tick has passed.
  void check_verdicts() {
    for (const auto& expected : verdicts_) {
      if (expected.tick > requested_tick_) continue;
      std::optional<msg::Reply> reply;
      wait_until([&] { return (reply = operator_.take_reply(expected.id, expected.source)).has_value(); },
                 "the answer to a request");
      if (!reply->accepted && !stopped()) throw RunError(std::string{"refused: "} + reply->reason);
    }
    std::erase_if(verdicts_, [this](const Verdict& expected) { return expected.tick <= requested_tick_; });
  }

  struct Verdict {
    std::uint64_t id;
    crane_Source source;
    std::uint64_t tick;
  };

  const Pump& pump_;
  const configuration::Rig& rig_;
  const Scenario& scenario_;
  TickLog& log_;
  bus::Options bus_;
  stack::OperatorClient operator_;
  TickSamples collected_;
  std::vector<OtherTopic> others_;
  std::vector<OtherSample> other_samples_;
  RunOutcome outcome_;
  std::vector<Verdict> verdicts_;
  std::optional<std::uint64_t> collected_tick_;
  std::uint64_t requested_tick_ = 0;
  crane_Source clock_master_ = crane_SOURCE_PLANT;  ///< or SOURCE_BRIDGE; executes kicks
  crane_SupervisorState state_ = crane_STATE_BOOT;
  crane_Cause cause_ = crane_CAUSE_NONE;
};

}  // namespace

RunOutcome run_scenario(bus::Bus& bus, const Pump& pump, const configuration::Rig& rig,
                        const Scenario& scenario, TickLog& log,
                        std::span<const runtime::ComponentSpec> components) {
  return LockstepRun{bus, pump, rig, scenario, log, components}.execute();
}

}  // namespace crane::experiments
