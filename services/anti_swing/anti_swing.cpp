#include "anti_swing/anti_swing.hpp"

#include "crane/control/pendulum_observer.hpp"
#include "crane/runtime/convert.hpp"

namespace crane::services {
namespace {

using runtime::Context;
constexpr double kWaitShare = 0.4;  // longest wait for the inputs of a tick, share of the period

/// Removes the swing feedback of axes with unknown position. Such an axis moves only during homing; swing
/// feedback would move the axis faster than the reference, and the bridge would find the mark at a wrong
/// position.
void remove_unknown_axes(const msg::State& state, control::Contribution& contribution) {
  for (std::size_t i = 0; i < control::kAxes; ++i) {
    if (state.position_known[i]) continue;
    contribution.drive_v[i] = 0;
    contribution.correction[i] = {};
  }
}

class AntiSwing : public runtime::JoinedComponent<msg::State, msg::Reference> {
 public:
  explicit AntiSwing(const Context& context)
      : JoinedComponent{context, kWaitShare, topics::state, topics::reference},
        law_{control::anti_swing_law(context.controller, context.rig.design)},
        output_{context.ports.output(topics::anti_swing)} {}

 protected:
  void on_tick(std::uint64_t /*tick*/, const msg::State* state, const msg::Reference* reference) override {
    const auto measured = runtime::measurement(*state);
    if (!started_) law_->reset(measured);
    started_ = true;
    auto contribution = law_->step(measured, runtime::reference(*reference));
    remove_unknown_axes(*state, contribution);
    msg::Contribution sample{};
    sample.header = runtime::answer_to(state->header);
    runtime::assign(sample.drive_v, contribution.drive_v);
    runtime::assign(sample.correction, contribution.correction);
    sample.second_writer = disputed();
    sample.configuration = configuration();
    output_.publish(sample);
  }

 private:
  std::unique_ptr<control::Law> law_;
  runtime::Output<msg::Contribution> output_;
  bool started_ = false;
};

}  // namespace

runtime::ComponentSpec anti_swing_spec() {
  return {
      .name = "anti_swing",
      .program = "crane_anti_swing",
      .summary = "Anti-swing law: volts, or a correction of the reference, that damp the swing of the load.",
      .source = crane_SOURCE_ANTI_SWING,
      .runs_controller = true,
      .reads = {{&topics::state.description, "swing angles and rates of the load"},
                {&topics::reference.description, "acceleration of the support"}},
      .writes = {{&topics::anti_swing.description,
                  "volts, or a correction of the reference, that damp the swing"}},
      .make = [](const Context& context) -> std::unique_ptr<runtime::Component> {
        return std::make_unique<AntiSwing>(context);
      }};
}

}  // namespace crane::services
