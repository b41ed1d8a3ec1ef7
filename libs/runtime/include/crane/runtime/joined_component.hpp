#pragma once
/// Base class of most components: it joins the samples of one tick and calls one step per tick.
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "crane/runtime/agreement.hpp"
#include "crane/runtime/component.hpp"
#include "crane/runtime/node.hpp"
#include "crane/runtime/process_name.hpp"
#include "crane/runtime/tick_join.hpp"

namespace crane::runtime {

/// @param share_of_period  real time: the component waits this share of the period for the other inputs of a
///   tick
/// @param depth            ticks that an input may be ahead of the slowest input
[[nodiscard]] inline JoinPolicy join_policy(const Context& context, double share_of_period,
                                            std::size_t depth = 8) {
  const auto period_ns = static_cast<std::int64_t>(context.rig.period_s * 1e9);
  const auto bound_ns = static_cast<std::int64_t>(share_of_period * context.rig.period_s * 1e9);
  return {.in_order = context.clock == Clock::lockstep,
          .bound_ns = context.clock == Clock::prescribed ? 0 : bound_ns,
          .depth = depth,
          .period_ns = context.clock == Clock::realtime ? period_ns : 0};
}

template <class... Inputs>
class JoinedComponent : public Component {
 public:
  [[nodiscard]] std::string_view name() const override { return node_.identity().name; }

  bool poll(std::int64_t now_ns) override {
    handle_requests(now_ns);
    const auto result = join_.poll(now_ns);
    node_.beat(now_ns, ports_, join_.counts());
    if (result == JoinResult::waiting) return on_idle(now_ns);
    if (result == JoinResult::incomplete && !steps_incomplete_ticks()) return true;
    ports_.watch(now_ns);
    disputed_ = ports_.disputed(now_ns);
    compare_configurations(std::index_sequence_for<Inputs...>{});
    const auto begin_ns = clock_ns();
    std::apply([this](const auto*... sample) { on_tick(join_.tick(), sample...); }, samples());
    const auto* leader = join_.template get<0>();
    node_.stepped(join_.tick(), leader != nullptr ? leader->header.sample_time_ns : 0, clock_ns() - begin_ns);
    return true;
  }
  [[nodiscard]] std::int64_t wake_at_ns() const override { return join_.due_ns().value_or(kNever); }
  [[nodiscard]] std::string waiting_for() const override {
    std::string text = "tick " + std::to_string(join_.next_tick()) + "; missing inputs:";
    for (std::size_t i = 0, named = 0; i < topic_names_.size(); ++i)
      if ((join_.missing() >> i & 1U) != 0) text.append(named++ == 0 ? " " : ", ").append(topic_names_[i]);
    return text;
  }

 protected:
  /// @param wait_share  real time: share of the period that the component waits for the other inputs of a
  ///   tick
  /// @param inputs      the joined topics; the first one is the leader, which opens the tick
  JoinedComponent(const Context& context, double wait_share, const topics::Topic<Inputs>&... inputs)
      : node_{context.node},
        ports_{context.ports},
        monotonic_ns_{context.monotonic_ns},
        join_{join_policy(context, wait_share), context.ports.loop_input(inputs)...},
        agreement_{context.node.identity().configuration},
        topic_names_{inputs.description.name...} {}

  /// Computes one step. The leader is never null; another input is null only when its sample is missing and
  /// steps_incomplete_ticks() is true.
  virtual void on_tick(std::uint64_t tick, const Inputs*... samples) = 0;
  [[nodiscard]] virtual bool steps_incomplete_ticks() const { return false; }
  virtual void handle_requests(std::int64_t /*now_ns*/) {}
  /// Called when no tick is complete. @return true when the call has processed something
  virtual bool on_idle(std::int64_t /*now_ns*/) { return false; }

  /// Sample of the leading topic for the open tick, which waits for its other inputs; null when no tick is
  /// open.
  [[nodiscard]] const auto* open_leader() const {
    return join_.open_tick() ? join_.template get<0>() : nullptr;
  }
  [[nodiscard]] const JoinCounts& counts() const { return join_.counts(); }
  /// True when a topic that this component reads had a second writer at the start of this step.
  [[nodiscard]] bool disputed() const { return disputed_; }
  /// Configuration of this process and of all newest inputs; 0 when they differ. Every output states it.
  [[nodiscard]] std::uint32_t configuration() const { return agreement_.configuration(); }
  /// Number of times that a new writer of the leading topic has taken over.
  [[nodiscard]] std::uint64_t restarts() const { return join_.restarts(); }
  [[nodiscard]] const Ports& ports() const { return ports_; }
  Node& node() { return node_; }

 private:
  [[nodiscard]] std::tuple<const Inputs*...> samples() const {
    return samples(std::index_sequence_for<Inputs...>{});
  }
  template <std::size_t... I>
  [[nodiscard]] std::tuple<const Inputs*...> samples(std::index_sequence<I...>) const {
    return {join_.template get<I>()...};
  }
  template <std::size_t... I>
  void compare_configurations(std::index_sequence<I...>) {
    (agreement_.note(I, join_.template get<I>()), ...);
    const auto other = agreement_.other();
    if (other && other != reported_)
      node_.error("configuration_differs",
                  std::string{process_name(*other)} + " has another rig file or controller than " +
                      node_.identity().name,
                  "restart the processes with the same rig file and controller");
    reported_ = other;
  }
  /// Time in ns, for the execution time of a step; 0 without a clock (Context::monotonic_ns).
  [[nodiscard]] std::int64_t clock_ns() const { return monotonic_ns_ != nullptr ? monotonic_ns_() : 0; }

  Node& node_;
  Ports& ports_;
  std::int64_t (*monotonic_ns_)();  ///< see Context
  TickJoin<Inputs...> join_;
  Agreement<sizeof...(Inputs)> agreement_;
  std::array<std::string_view, sizeof...(Inputs)> topic_names_;
  std::optional<crane_Source> reported_;  ///< process with another configuration, named in the last event
  bool disputed_ = false;
};

}  // namespace crane::runtime
