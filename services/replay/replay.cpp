#include "replay/replay.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "crane/bus/seal.hpp"
#include "replay/prescribed_stack.hpp"
#include "replay/replayed_stack.hpp"
#include "stack/stack.hpp"

namespace crane::replay {
namespace {

/// In the order of the data flow of one tick.
const std::array kCompared{&topics::reference.description,  &topics::tracking.description,
                           &topics::anti_swing.description, &topics::demand.description,
                           &topics::command.description,    &topics::supervisor.description};

std::optional<msg::State> state_of(const RecordedTick& tick) {
  const auto* cdr = tick.find(topics::state.description);
  return cdr == nullptr ? std::nullopt : decoded(topics::state, *cdr);
}

class Comparison {
 public:
  Comparison(RecordedRun& run, ReplayedStack& stack) : run_{run}, stack_{stack} {}

  Result make() {
    run_.for_each([this](const RecordedTick& tick) { return add(tick); });
    if (next_ == begin_ && !result_.first)
      throw Refusal("no tick of the recording can be replayed" +
                    (result_.ends.empty() ? "" : "; " + result_.ends) + damage());
    result_.by_recorder = run_.by_recorder();
    result_.decided_by_outputs = stack_.decided_by_outputs();
    result_.equal_ticks = next_ - begin_;
    result_.assumed_ticks = run_.assumed_ticks();
    result_.problems = run_.problems();
    result_.origin = run_.origin();
    return result_;
  }

 private:
  /// @return true when the replay goes on with the next tick
  bool add(const RecordedTick& tick) {
    if (tick.begins) begin_ = next_ = tick.number;
    if (next_ == 0 && tick.number != 0)
      throw Refusal("the recording begins with tick " + std::to_string(tick.number) +
                    "; a replay needs tick 0, because the components have memory" + damage());
    if (!tick.ends.empty()) {
      result_.ends = "tick " + std::to_string(tick.number) + ": " + tick.ends;
      return false;
    }
    if (stack_.is_prescribed() && run_.problems().empty() && tick.number > next_) {
      result_.skipped_ticks += tick.number - next_;  // by the bridge, without a sample of any process
      next_ = tick.number;
    }
    if (stack_.is_prescribed() && tick.number == next_ && tick.find(topics::state.description) == nullptr)
      return skips(tick);
    const auto state = tick.number == next_ ? state_of(tick) : std::nullopt;
    if (!state) return misses(topics::state.description, tick);
    time_s_ = static_cast<double>(state->header.sample_time_ns) / 1e9;
    if (!is_intact(*state)) return false;
    note_irregularity(tick);
    if (!stack_.is_prescribed() && !tick.without_state.empty()) return end(tick.irregular);
    if (!stack_.receive(tick)) {
      if (!stack_.is_prescribed()) throw Refusal("tick " + std::to_string(next_) + ": a sample is not valid");
      return end("a process had a sample that is in neither the recording nor the replay");
    }
    for (const auto* topic : kCompared)
      if (is_compared(*topic, tick) && !is_equal(*topic, tick)) return false;
    if (!are_equal_without_state(tick)) return false;
    stack_.forget_until(next_++);
    return true;
  }

  bool end(const std::string& reason) {
    result_.ends = "tick " + std::to_string(next_) + ": " + reason;
    return false;
  }

  /// The bridge has skipped this tick, whose reference the planner has published in the tick before.
  bool skips(const RecordedTick& tick) {
    ++result_.skipped_ticks;
    if (!is_equal(topics::reference.description, tick)) return false;
    stack_.forget_until(next_++);
    return true;
  }

  void note_irregularity(const RecordedTick& tick) {
    if (stack_.is_prescribed() && tick.steps.planner_may_lack_status && !stack_.infers_inputs_from_outputs())
      doubt_ = Doubt{next_, "the planner may have lacked crane/supervisor"};
    if (tick.irregular.empty()) return;
    ++result_.irregular_ticks;
    result_.steps_without_state += tick.without_state.size();
    // The recording does not state the exact time of a step without a state.
    if (!stack_.is_prescribed() || !tick.without_state.empty()) doubt_ = Doubt{next_, tick.irregular};
  }

  bool are_equal_without_state(const RecordedTick& tick) {
    std::vector<const Cdr*> commands, statuses;
    for (const auto& repeated : stack_.repeated()) {
      if (repeated.topic->name == topics::command.description.name) commands.push_back(&repeated.cdr);
      if (repeated.topic->name == topics::supervisor.description.name) statuses.push_back(&repeated.cdr);
    }
    const auto& steps = tick.without_state;
    for (std::size_t i = 0; i < std::max(steps.size(), statuses.size()); ++i) {
      const auto at = [i](const auto& replayed) { return i < replayed.size() ? replayed[i] : nullptr; };
      if (i >= steps.size())
        return differs(topics::supervisor.description, {"", "no sample", "a sample without a new state"});
      if (steps[i].command && !is_same(topics::command.description, *steps[i].command, at(commands)))
        return false;
      if (!is_same(topics::supervisor.description, steps[i].status, at(statuses))) return false;
    }
    return true;
  }

  /// A changed measurement is not a difference of the components. The checksum of the sample shows the
  /// change.
  bool is_intact(const msg::State& state) {
    if (bus::intact(topics::state.description, &state)) return true;
    auto sealed = state;
    bus::seal(topics::state.description, &sealed, state.header.source, state.header.epoch);
    return differs(topics::state.description,
                   {"crc32c", std::to_string(state.crc32c), std::to_string(sealed.crc32c)});
  }

  /// The reference of the first tick is not compared: a planner that started before the stack was complete
  /// published it from the previous state.
  static bool is_compared(const topics::Description& topic, const RecordedTick& tick) {
    return !tick.assumed && !(tick.begins && topic.name == topics::reference.description.name);
  }

  bool is_equal(const topics::Description& topic, const RecordedTick& tick) {
    const auto* recorded = tick.find(topic);
    const auto* replayed = stack_.find(topic, next_);
    if (recorded == nullptr && run_.by_recorder()) return is_not_recorded(topic, replayed);
    return recorded == nullptr ? misses(topic, tick) : is_same(topic, *recorded, replayed);
  }

  bool is_same(const topics::Description& topic, const Cdr& recorded, const Cdr* replayed) {
    if (replayed == nullptr) return differs(topic, {"", "a sample", "no sample"});
    const auto header = run_.by_recorder() ? header_of(recorded) : std::nullopt;
    const auto found =
        first_difference(topic, recorded, header ? with_epoch(topic, *replayed, header->epoch) : *replayed);
    return !found || differs(topic, *found);
  }

  /// @param replayed  null: the recording shows that the process did not step
  bool is_not_recorded(const topics::Description& topic, const Cdr* replayed) {
    if (replayed == nullptr) return true;
    ++result_.not_recorded;
    if (stack_.is_prescribed()) return true;
    doubt_ =
        Doubt{next_, std::string{topic.name} + " is not in the recording: a process was late or has ended"};
    return true;
  }

  /// A process that was late, or has ended, published no sample, and its readers continued without the
  /// sample. A difference soon after a missing sample is therefore attributed to the missing sample, not to
  /// the program.
  bool differs(const topics::Description& topic, FieldDifference what) {
    constexpr std::uint64_t kEffect_ticks = 2;
    if (doubt_ && next_ - doubt_->tick <= kEffect_ticks)
      return end("its " + std::string{topic.name} + " differs, and in tick " + std::to_string(doubt_->tick) +
                 ' ' + doubt_->what);
    result_.first = Difference{next_, time_s_, std::string{topic.name}, std::move(what)};
    return false;
  }

  /// A damaged recording ends before its first tick without all samples. In an intact recording, a missing
  /// sample is a difference.
  bool misses(const topics::Description& topic, const RecordedTick& tick) {
    if (!tick.irregular.empty()) return end(tick.irregular);
    if (run_.problems().empty()) return differs(topic, {"", "no sample", "a sample"});
    return false;
  }

  [[nodiscard]] std::string damage() const {
    std::string lines;
    for (const auto& problem : run_.problems()) lines += '\n' + problem;
    return lines;
  }

  RecordedRun& run_;
  ReplayedStack& stack_;
  Result result_;
  struct Doubt {
    std::uint64_t tick;
    std::string what;
  };
  std::optional<Doubt> doubt_;  ///< last tick that the replay cannot repeat for certain
  std::uint64_t begin_ = 0;     ///< first tick
  std::uint64_t next_ = 0;      ///< next tick to compare
  double time_s_ = 0;
};

}  // namespace

std::vector<runtime::ComponentSpec> loop_components() {
  auto components = stack::simulated_stack();
  components.erase(components.begin());  // the clock master
  return components;
}

Result replay(const std::filesystem::path& file, std::span<const runtime::ComponentSpec> components) {
  RecordedRun run{file};
  if (run.by_recorder()) {
    PrescribedStack stack{components, run.rig(), run.controller()};
    return Comparison{run, stack}.make();
  }
  InProcessReplay stack{components, run.rig(), run.controller()};
  return Comparison{run, stack}.make();
}

Result replay_in_processes(const std::filesystem::path& file, const ProcessOptions& options) {
  RecordedRun run{file};
  ProcessReplay stack{loop_components(), run, options};
  return Comparison{run, stack}.make();
}

std::string sentence(const Difference& difference) {
  std::array<char, 32> time_s{};
  std::snprintf(time_s.data(), time_s.size(), "%.6g", difference.time_s);
  return difference.topic + " of tick " + std::to_string(difference.tick) + " (" + time_s.data() +
         " s): " + (difference.what.field.empty() ? "" : difference.what.field + ": ") + "recorded " +
         difference.what.recorded + ", replayed " + difference.what.replayed;
}

}  // namespace crane::replay
