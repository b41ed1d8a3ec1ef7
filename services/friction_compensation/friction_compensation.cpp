#include "friction_compensation/friction_compensation.hpp"

#include <algorithm>
#include <optional>

#include "crane/control/adaptation.hpp"
#include "crane/control/friction_compensation.hpp"
#include "crane/runtime/convert.hpp"
#include "friction_compensation/adaptation_sample.hpp"

namespace crane::services {
namespace {

using runtime::Context;
/// Longest wait for the inputs of a tick, share of the period. It is longer than that of tracking and
/// anti-swing, whose outputs are inputs here.
constexpr double kWaitShare = 0.5;

/// Largest rate of the compensation / rate limit of the gate. The laws have the other half.
constexpr double kShareOfRate = 0.5;

bool adapts(const control::Design& design) { return design.adaptation.enabled; }

class FrictionCompensation
    : public runtime::JoinedComponent<msg::State, msg::Contribution, msg::Contribution> {
 public:
  explicit FrictionCompensation(const Context& context)
      : JoinedComponent{context, kWaitShare, topics::state, topics::tracking, topics::anti_swing},
        friction_{context.rig.design.friction},
        output_{context.ports.output(topics::demand)} {
    for (std::size_t i = 0; i < control::kAxes; ++i)
      largest_step_v_[i] = kShareOfRate * context.rig.drives[i].volt_rate_limit_vps * context.rig.period_s;
    if (adapts(context.rig.design))
      adaptation_.emplace(control::Adaptation{context.rig.design}, context.ports.output(topics::adaptation));
  }

 protected:
  void on_tick(std::uint64_t tick, const msg::State* state, const msg::Contribution* tracking,
               const msg::Contribution* anti_swing) override {
    const auto speed = runtime::measurement(*state).speed;
    if (adaptation_) adapt(tick, *state);
    msg::Demand sample{};
    sample.header = runtime::answer_to(state->header);
    for (std::size_t i = 0; i < control::kAxes; ++i) {
      sample.control_v[i] = tracking->drive_v[i] + anti_swing->drive_v[i];
      const double friction_v = control::friction_compensation_v(friction_[i], sample.control_v[i], speed[i]);
      // With a period of about 1 ms, the jump at a change of direction exceeds the rate limit of the gate,
      // which would count it as a fault of the controller.
      sample.friction_v[i] = friction_v_[i] =
          std::clamp(friction_v, friction_v_[i] - largest_step_v_[i], friction_v_[i] + largest_step_v_[i]);
      sample.total_v[i] = sample.control_v[i] + sample.friction_v[i];
    }
    sample.second_writer = disputed() || tracking->second_writer || anti_swing->second_writer;
    sample.configuration = configuration();
    output_.publish(sample);
    if (!adaptation_) return;
    std::ranges::copy(sample.total_v, demand_v_.begin());
    adaptation_->output.publish(
        adaptation_sample(runtime::answer_to(state->header), adaptation_->law.report()));
  }

 private:
  /// Updates the levels of the compensation from the motion and the voltages of this tick.
  void adapt(std::uint64_t tick, const msg::State& state) {
    control::AdaptationInput input{
        .measured = runtime::measurement(state),
        .demand_v = demand_v_,
        .brake_closed = {},
        .consecutive = tick == last_tick_ + 1 && state.applied_command_tick == last_tick_};
    std::ranges::copy(state.brake_closed, input.brake_closed.begin());
    last_tick_ = tick;
    adaptation_->law.step(input);
    friction_ = adaptation_->law.friction();
  }

  struct Adapting {
    control::Adaptation law;
    runtime::Output<msg::Adaptation> output;
  };
  std::array<control::DriveFriction, control::kAxes> friction_;
  control::Volts largest_step_v_{};  ///< largest change of the compensation in one tick
  control::Volts friction_v_{};      ///< compensation of the last tick
  runtime::Output<msg::Demand> output_;
  std::optional<Adapting> adaptation_;  ///< nothing: the rig file adapts no axis
  control::Volts demand_v_{};           ///< of the last tick
  std::uint64_t last_tick_ = 0;
};

}  // namespace

runtime::ComponentSpec friction_compensation_spec() {
  return {
      .name = "friction_compensation",
      .program = "crane_friction_compensation",
      .summary = "Friction compensation: adds the volts of both laws and the estimated friction.",
      .source = crane_SOURCE_FRICTION,
      .runs_controller = false,
      .reads = {{&topics::state.description, "speeds of the axes"},
                {&topics::tracking.description, "volts of the tracking law"},
                {&topics::anti_swing.description, "volts of the anti-swing law"}},
      .writes = {{&topics::demand.description, "sum of the contributions and of the friction compensation"},
                 {&topics::adaptation.description, "estimated friction and load", false, adapts}},
      .make = [](const Context& context) -> std::unique_ptr<runtime::Component> {
        return std::make_unique<FrictionCompensation>(context);
      }};
}

}  // namespace crane::services
