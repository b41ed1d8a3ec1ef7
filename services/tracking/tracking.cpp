#include "tracking/tracking.hpp"

#include "crane/control/pendulum_observer.hpp"
#include "crane/runtime/convert.hpp"

namespace crane::services {
namespace {

using runtime::Context;

/// The tracking law, its memory and its output sample.
class TrackingStep {
 public:
  explicit TrackingStep(const Context& context)
      : law_{control::tracking_law(context.controller, context.rig.design)},
        output_{context.ports.output(topics::tracking)} {}

  void operator()(const msg::State& state, const control::Reference& reference, bool disputed,
                  std::uint32_t configuration) {
    const auto measured = runtime::measurement(state);
    if (!started_) law_->reset(measured);
    started_ = true;
    const auto contribution = law_->step(measured, reference);
    msg::Contribution sample{};
    sample.header = runtime::answer_to(state.header);
    runtime::assign(sample.drive_v, contribution.drive_v);
    sample.second_writer = disputed;
    sample.configuration = configuration;
    output_.publish(sample);
  }

 private:
  std::unique_ptr<control::Law> law_;
  runtime::Output<msg::Contribution> output_;
  bool started_ = false;
};

constexpr double kWaitShare = 0.4;  // longest wait for the inputs of a tick, share of the period

class Tracking : public runtime::JoinedComponent<msg::State, msg::Reference> {
 public:
  explicit Tracking(const Context& context)
      : JoinedComponent{context, kWaitShare, topics::state, topics::reference}, step_{context} {}

 protected:
  void on_tick(std::uint64_t /*tick*/, const msg::State* state, const msg::Reference* reference) override {
    step_(*state, runtime::reference(*reference), disputed(), configuration());
  }

 private:
  TrackingStep step_;
};

/// Tracking law behind an anti-swing law that corrects the reference instead of adding volts (figure 3.18 of
/// H. M. Omar, Control of Gantry and Tower Cranes).
class CorrectedTracking : public runtime::JoinedComponent<msg::State, msg::Reference, msg::Contribution> {
 public:
  explicit CorrectedTracking(const Context& context)
      : JoinedComponent{context, kWaitShare, topics::state, topics::reference, topics::anti_swing},
        step_{context} {}

 protected:
  void on_tick(std::uint64_t /*tick*/, const msg::State* state, const msg::Reference* reference,
               const msg::Contribution* anti_swing) override {
    auto wanted = runtime::reference(*reference);
    const auto correction = runtime::reference(anti_swing->correction);
    for (std::size_t i = 0; i < control::kAxes; ++i) {
      wanted[i].position += correction[i].position;
      wanted[i].speed += correction[i].speed;
      wanted[i].acceleration += correction[i].acceleration;
    }
    step_(*state, wanted, disputed(), configuration());
  }

 private:
  TrackingStep step_;
};

bool corrects_reference(const control::Controller& controller) { return controller.corrects_reference; }

}  // namespace

runtime::ComponentSpec tracking_spec() {
  return {
      .name = "tracking",
      .program = "crane_tracking",
      .summary = "Tracking law: volts that make trolley, slew and hoist follow their reference.",
      .source = crane_SOURCE_TRACKING,
      .runs_controller = true,
      .reads = {{&topics::state.description, "positions and speeds of the axes"},
                {&topics::reference.description, "position, speed and acceleration that each axis must have"},
                {&topics::anti_swing.description, "correction of the reference", corrects_reference}},
      .writes = {{&topics::tracking.description, "volts that keep the axes on their reference"}},
      .make = [](const Context& context) -> std::unique_ptr<runtime::Component> {
        if (context.controller.corrects_reference) return std::make_unique<CorrectedTracking>(context);
        return std::make_unique<Tracking>(context);
      }};
}

}  // namespace crane::services
