#include "crane/twin/component.hpp"

#include <algorithm>
#include <chrono>

#include "crane/runtime/convert.hpp"
#include "crane/runtime/node.hpp"
#include "crane/twin/twin.hpp"

namespace crane::twin {
namespace {

Sample sample_of(const msg::State& state) {
  Sample sample;
  sample.tick = state.header.tick;
  sample.epoch = state.header.epoch;
  std::copy(std::begin(state.counts), std::end(state.counts), sample.counts.begin());
  sample.rate = {state.trolley_speed_mps, state.slew_speed_radps, state.swing_radial_radps,
                 state.swing_tangential_radps};
  sample.cable_mps = state.cable_speed_mps;
  sample.applied_v = runtime::values(state.applied_v);
  for (std::size_t i = 0; i < plant::kAxes; ++i)
    sample.held[i] = state.brake_closed[i] || state.limit_low[i] || state.limit_high[i];
  sample.homed = std::all_of(std::begin(state.position_known), std::end(state.position_known),
                             [](bool known) { return known; });
  return sample;
}

msg::Twin message_of(const Judgement& judgement, const msg::Header& cause) {
  msg::Twin message{};
  message.header = runtime::answer_to(cause);
  message.state = static_cast<crane_TwinState>(judgement.state);
  for (std::size_t i = 0; i < kColumns; ++i)
    message.column[i] = {judgement.predicted[i], judgement.residual[i], judgement.band[i]};
  message.evidence = judgement.evidence;
  runtime::assign(message.cause, judgement.cause);
  runtime::assign(message.axis, judgement.axis);
  message.size = judgement.size;
  message.size_std = judgement.size_std;
  runtime::assign(message.unit, judgement.unit);
  message.learnt_share = judgement.learnt_share;
  message.judged_ticks = judgement.judged_ticks;
  message.gaps = judgement.gaps;
  return message;
}

class TwinComponent : public runtime::Component {
 public:
  explicit TwinComponent(const runtime::Context& context)
      : node_{context.node},
        ports_{context.ports},
        twin_{context.rig},
        states_{context.ports.loop_input(topics::state)},
        output_{context.ports.output(topics::twin)} {}

  [[nodiscard]] std::string_view name() const override { return node_.identity().name; }
  [[nodiscard]] std::string waiting_for() const override { return "the tick after " + std::to_string(tick_); }
  /// Publishes the status once a second, also without samples of crane/state.
  [[nodiscard]] std::int64_t wake_at_ns() const override { return beaten_ns_ + kBeat_ns; }

  bool poll(std::int64_t now_ns) override {
    std::size_t one = 1;
    const auto state = states_->take(now_ns, one);
    if (state) step(state->sample);
    if (!state && now_ns < beaten_ns_ + kBeat_ns && ports_.connected() == was_connected_) return false;
    was_connected_ = ports_.connected();
    beaten_ns_ = now_ns;
    counts_.lost = twin_.judgement().gaps;
    ports_.watch(now_ns);
    node_.beat(now_ns, ports_, counts_);
    return state.has_value();
  }

 private:
  static constexpr std::int64_t kBeat_ns = 1'000'000'000;

  void step(const msg::State& state) {
    const auto begin = std::chrono::steady_clock::now();
    const auto header = state.header;
    output_.publish(message_of(twin_.step(sample_of(state)), header));
    const auto spent = std::chrono::steady_clock::now() - begin;
    tick_ = header.tick;
    ++counts_.completed;
    node_.stepped(header.tick, header.sample_time_ns, std::chrono::nanoseconds{spent}.count());
    if (const auto notice = twin_.take_notice()) {
      if (notice->deviates)
        node_.warning("twin_deviates", notice->what, notice->remedy);
      else
        node_.info("twin_agrees", notice->what);
    }
  }

  runtime::Node& node_;
  runtime::Ports& ports_;
  Twin twin_;
  std::shared_ptr<runtime::LoopReader<msg::State>> states_;
  runtime::Output<msg::Twin> output_;
  runtime::JoinCounts counts_;
  std::uint64_t tick_ = 0;
  std::int64_t beaten_ns_ = 0;
  bool was_connected_ = false;
};

}  // namespace

runtime::ComponentSpec twin_spec() {
  return {.name = "twin",
          .program = "crane_twin",
          .summary = "Live twin: predicts the sensor values with the model and reports deviations.",
          .source = crane_SOURCE_TWIN,
          .runs_controller = false,
          .reads = {{&topics::state.description, "counts, speeds and the voltage that acts"}},
          .writes = {{&topics::twin.description, "prediction, residual, likely cause", false}},
          .make = [](const runtime::Context& context) -> std::unique_ptr<runtime::Component> {
            return std::make_unique<TwinComponent>(context);
          }};
}

}  // namespace crane::twin
