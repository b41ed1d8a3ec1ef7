#pragma once
/// Combines the samples of one tick from several topics. The first input is the leader: its sample k opens
/// tick k. Real time: the newest tick stays open for a bounded time; if an input is still missing
/// then, the tick counts as lost. Lockstep: the ticks are opened one after the other, without a
/// time limit.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "crane/runtime/loop_reader.hpp"

namespace crane::runtime {

struct JoinPolicy {
  bool in_order = true;  ///< true: lockstep; false: real time
  /// Real time: longest wait for the other inputs after the poll() that opens the tick. If the first poll()
  /// after the wait is late by bound_ns / 2 or more, the tick waits once more, for bound_ns / 2. 0: no wait;
  /// the second poll() finishes the tick without its missing inputs.
  std::int64_t bound_ns = 0;
  std::size_t depth = 8;       ///< ticks that an input may be ahead of the slowest input
  std::int64_t period_ns = 0;  ///< real time: period of the ticks, for the check of tick numbers; 0: no check
};

/// Counts since creation.
struct JoinCounts {
  std::uint64_t completed = 0;  ///< ticks with all inputs
  std::uint64_t lost = 0;       ///< ticks with a missing input or a missing leader
  std::uint64_t late = 0;       ///< samples of a tick that is already finished
  std::uint64_t duplicate = 0;  ///< second samples of one tick
  std::uint64_t ahead = 0;      ///< dropped samples of a tick that cannot have begun yet
};

/// Buffer for the samples of one topic, by tick.
template <class T>
class TickInput {
 public:
  TickInput(std::shared_ptr<LoopReader<T>> reader, const JoinPolicy& policy)
      : reader_{std::move(reader)}, policy_{policy}, ring_(policy.depth) {}

  /// Takes the samples that have arrived. @return true when a new writer took over; its samples then replace
  /// all others
  bool drain(std::uint64_t first_useful_tick, std::int64_t now_ns, JoinCounts& counts) {
    bool restarted = false;
    std::size_t budget = LoopReader<T>::kMostPerPoll;
    while (const auto taken = reader_->take(now_ns, budget)) {
      if (taken->taken_over) {
        restarted = true;
        first_useful_tick = 0;
        for (auto& slot : ring_) slot.reset();
        newest_.reset();
      }
      store(taken->sample, first_useful_tick, now_ns, counts);
    }
    return restarted;
  }
  [[nodiscard]] const T* find(std::uint64_t tick) const {
    const auto& slot = ring_[tick % ring_.size()];
    return slot && slot->header.tick == tick ? &*slot : nullptr;
  }
  [[nodiscard]] std::optional<std::uint64_t> newest() const { return newest_; }
  [[nodiscard]] std::optional<std::uint64_t> oldest() const {
    std::optional<std::uint64_t> tick;
    for (const auto& slot : ring_)
      if (slot && (!tick || slot->header.tick < *tick)) tick = slot->header.tick;
    return tick;
  }

 private:
  void store(const T& sample, std::uint64_t first_useful_tick, std::int64_t now_ns, JoinCounts& counts) {
    const auto tick = sample.header.tick;
    if (find(tick) != nullptr) {
      ++counts.duplicate;
    } else if (tick < first_useful_tick) {
      ++counts.late;
    } else if (is_ahead(tick, now_ns)) {
      ++counts.ahead;
    } else {
      ring_[tick % ring_.size()] = sample;
      if (newest_ && tick <= *newest_) return;
      newest_ = tick;
      newest_ns_ = now_ns;
    }
  }
  /// A wrong tick number far ahead would make all following samples late. The limit is twice the nominal
  /// number of ticks since the newest sample, because the clocks of two hosts differ, plus the length of the
  /// queue of the reader, because queued samples are taken at the same time.
  [[nodiscard]] bool is_ahead(std::uint64_t tick, std::int64_t now_ns) const {
    constexpr std::uint64_t kQueued_ticks = 128;
    if (policy_.period_ns <= 0 || !newest_ || tick <= *newest_) return false;
    const auto elapsed = static_cast<std::uint64_t>((now_ns - newest_ns_) / policy_.period_ns);
    return tick - *newest_ > 2 * elapsed + kQueued_ticks;
  }

  std::shared_ptr<LoopReader<T>> reader_;
  JoinPolicy policy_;
  std::vector<std::optional<T>> ring_;
  std::optional<std::uint64_t> newest_;
  std::int64_t newest_ns_ = 0;  ///< time at which the newest sample was taken
};

enum class JoinResult : std::uint8_t {
  waiting,    ///< no tick is open, or the open tick waits for inputs
  complete,   ///< every input of tick() has arrived
  incomplete  ///< the bound has passed; get() is null for missing inputs
};

template <class... T>
class TickJoin {
 public:
  explicit TickJoin(const JoinPolicy& policy, std::shared_ptr<LoopReader<T>>... inputs)
      : policy_{policy}, inputs_{TickInput<T>{std::move(inputs), policy}...} {}

  JoinResult poll(std::int64_t now_ns) {
    drain(now_ns);
    if (!open(now_ns)) return JoinResult::waiting;
    if (missing() == 0) return finish(JoinResult::complete);
    if (policy_.in_order || now_ns < due_ns_ || woke_late(now_ns)) return JoinResult::waiting;
    return finish(JoinResult::incomplete);
  }

  /// Tick of the last result; valid until the next poll().
  [[nodiscard]] std::uint64_t tick() const { return tick_; }
  /// Sample of input I for tick(); null when it is missing. Valid until the next poll().
  template <std::size_t I>
  [[nodiscard]] auto get() const {
    return std::get<I>(inputs_).find(tick_);
  }
  /// The open tick: its leader has arrived, other inputs are missing.
  [[nodiscard]] std::optional<std::uint64_t> open_tick() const {
    return opened_ ? std::optional{tick_} : std::nullopt;
  }
  /// Time at which poll() must be called to finish the open tick without its missing inputs.
  [[nodiscard]] std::optional<std::int64_t> due_ns() const {
    if (policy_.in_order || !opened_) return std::nullopt;
    return due_ns_;
  }
  [[nodiscard]] const JoinCounts& counts() const { return counts_; }
  /// Number of times that a new writer of the leading topic has taken over.
  [[nodiscard]] std::uint64_t restarts() const { return restarts_; }
  /// Bit i is set when input i of the open tick is missing; bit 0 is also set when no tick is open.
  [[nodiscard]] std::uint32_t missing() const { return missing(std::index_sequence_for<T...>{}); }
  [[nodiscard]] std::uint64_t next_tick() const { return opened_ ? tick_ : first_useful_; }

 private:
  void drain(std::int64_t now_ns) {
    if (std::get<0>(inputs_).drain(first_useful_, now_ns, counts_)) {
      ++restarts_;
      first_useful_ = 0;
      started_ = opened_ = false;
    }
    std::apply([&](auto&, auto&... others) { (others.drain(first_useful_, now_ns, counts_), ...); }, inputs_);
  }
  /// Opens the next tick. @return false when no tick can be opened
  bool open(std::int64_t now_ns) {
    const auto candidate = policy_.in_order ? next_in_order() : std::get<0>(inputs_).newest();
    if (!candidate || (started_ && *candidate < first_useful_)) return false;
    if (opened_ && *candidate == tick_) return true;
    if (started_) counts_.lost += *candidate - first_useful_;
    tick_ = first_useful_ = *candidate;
    started_ = opened_ = true;
    due_ns_ = now_ns + policy_.bound_ns;
    wait_extended_ = false;
    return true;
  }
  /// After a late wake-up, samples may have arrived that are not yet delivered: extends the wait by half the
  /// bound, once per tick.
  bool woke_late(std::int64_t now_ns) {
    if (wait_extended_ || now_ns < due_ns_ + policy_.bound_ns / 2) return false;
    due_ns_ = now_ns + policy_.bound_ns / 2;
    return wait_extended_ = true;
  }
  [[nodiscard]] std::optional<std::uint64_t> next_in_order() const {
    const auto& leader = std::get<0>(inputs_);
    if (!started_) return leader.oldest();
    return leader.find(first_useful_) != nullptr ? std::optional{first_useful_} : std::nullopt;
  }
  template <std::size_t... I>
  [[nodiscard]] std::uint32_t missing(std::index_sequence<I...>) const {
    if (!opened_) return 1;
    return ((get<I>() == nullptr ? 1U << I : 0U) | ...);
  }
  JoinResult finish(JoinResult result) {
    ++(result == JoinResult::complete ? counts_.completed : counts_.lost);
    opened_ = false;
    first_useful_ = tick_ + 1;
    return result;
  }

  JoinPolicy policy_;
  std::tuple<TickInput<T>...> inputs_;
  JoinCounts counts_;
  std::uint64_t restarts_ = 0;
  std::uint64_t tick_ = 0;
  std::uint64_t first_useful_ = 0;  ///< all earlier ticks are finished
  std::int64_t due_ns_ = 0;         ///< end of the wait for the other inputs of the open tick
  bool wait_extended_ = false;      ///< true: the wait of the open tick has been extended
  bool started_ = false, opened_ = false;
};

}  // namespace crane::runtime
