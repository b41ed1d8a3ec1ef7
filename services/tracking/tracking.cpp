#include "tracking/tracking.hpp"

#include "crane/runtime/convert.hpp"

namespace crane::services {
namespace {

using runtime::Context;

/// The law, its memory, and the sample it fills.
class TrackingStep {
 public:
  explicit TrackingStep(const Context& context)
      : law_{context.controller.make_tracking(context.rig.design)},
        output_{context.bus.publisher(topics::tracking, runtime::loop_endpoint(context.clock))} {}

  void operator()(const msg::State& state, const control::Reference& reference) {
    const auto measured = runtime::measurement(state);
    if (!started_) law_->reset(measured);
    started_ = true;
    const auto contribution = law_->step(measured, reference);
    msg::Contribution sample{};
    sample.header = runtime::answer_to(state.header);
    runtime::assign(sample.drive_v, contribution.drive_v);
    output_.publish(sample);
  }
  [[nodiscard]] bool connected() const { return output_.matched() > 0; }

 private:
  std::unique_ptr<control::Law> law_;
  bus::Publisher<msg::Contribution> output_;
  bool started_ = false;
};

constexpr double kWaitShare = 0.4;  // of a period, for the rest of a tick

class Tracking : public runtime::JoinedComponent<msg::State, msg::Reference> {
 public:
  explicit Tracking(const Context& context)
      : JoinedComponent{context, runtime::join_policy(context, kWaitShare),
                        context.bus.subscriber(topics::state, runtime::loop_endpoint(context.clock)),
                        context.bus.subscriber(topics::reference, runtime::loop_endpoint(context.clock))},
        step_{context} {}

 protected:
  void on_tick(std::uint64_t /*tick*/, const msg::State* state, const msg::Reference* reference) override {
    step_(*state, runtime::reference(reference->axis));
  }
  [[nodiscard]] bool outputs_connected() const override { return step_.connected(); }

 private:
  TrackingStep step_;
};

/// For controllers whose anti-swing law moves the reference instead of giving volts (figure 3.18).
class CorrectedTracking : public runtime::JoinedComponent<msg::State, msg::Reference, msg::Contribution> {
 public:
  explicit CorrectedTracking(const Context& context)
      : JoinedComponent{context, runtime::join_policy(context, kWaitShare),
                        context.bus.subscriber(topics::state, runtime::loop_endpoint(context.clock)),
                        context.bus.subscriber(topics::reference, runtime::loop_endpoint(context.clock)),
                        context.bus.subscriber(topics::anti_swing, runtime::loop_endpoint(context.clock))},
        step_{context} {}

 protected:
  void on_tick(std::uint64_t /*tick*/, const msg::State* state, const msg::Reference* reference,
               const msg::Contribution* anti_swing) override {
    auto wanted = runtime::reference(reference->axis);
    const auto correction = runtime::reference(anti_swing->correction);
    for (std::size_t i = 0; i < control::kAxes; ++i) {
      wanted[i].position += correction[i].position;
      wanted[i].speed += correction[i].speed;
      wanted[i].acceleration += correction[i].acceleration;
    }
    step_(*state, wanted);
  }
  [[nodiscard]] bool outputs_connected() const override { return step_.connected(); }

 private:
  TrackingStep step_;
};

}  // namespace

runtime::ComponentSpec tracking_spec() {
  return {.name = "tracking",
          .program = "crane_tracking",
          .summary = "Volts that keep trolley, slew and hoist on their reference.",
          .source = crane_SOURCE_TRACKING,
          .runs_controller = true,
          .sole_writer_of = &topics::tracking.description,
          .make = [](const Context& context) -> std::unique_ptr<runtime::Component> {
            if (context.controller.corrects_reference) return std::make_unique<CorrectedTracking>(context);
            return std::make_unique<Tracking>(context);
          }};
}

}  // namespace crane::services
