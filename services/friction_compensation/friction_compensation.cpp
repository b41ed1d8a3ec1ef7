#include "friction_compensation/friction_compensation.hpp"

#include "crane/control/friction_compensation.hpp"
#include "crane/runtime/convert.hpp"

namespace crane::services {
namespace {

using runtime::Context;
/// Longest wait for the inputs of a tick / period. The inputs of tracking and anti-swing arrive before.
constexpr double kWaitShare = 0.5;

bool adapts(const control::Design& design) { return design.adaptation.enabled; }

class FrictionCompensation
    : public runtime::JoinedComponent<msg::State, msg::Contribution, msg::Contribution> {
 public:
  explicit FrictionCompensation(const Context& context)
      : JoinedComponent{context, kWaitShare, topics::state, topics::tracking, topics::anti_swing},
        friction_{context.rig.design.friction},
        output_{context.ports.output(topics::demand)} {
    if (adapts(context.rig.design)) adaptation_.emplace(context.ports.output(topics::adaptation));
  }

 protected:
  void on_tick(std::uint64_t /*tick*/, const msg::State* state, const msg::Contribution* tracking,
               const msg::Contribution* anti_swing) override {
    const auto speed = runtime::measurement(*state).speed;
    msg::Demand sample{};
    sample.header = runtime::answer_to(state->header);
    for (std::size_t i = 0; i < control::kAxes; ++i) {
      sample.control_v[i] = tracking->drive_v[i] + anti_swing->drive_v[i];
      sample.friction_v[i] = control::friction_compensation_v(friction_[i], sample.control_v[i], speed[i]);
      sample.total_v[i] = sample.control_v[i] + sample.friction_v[i];
    }
    sample.second_writer = disputed() || tracking->second_writer || anti_swing->second_writer;
    sample.configuration = configuration();
    output_.publish(sample);
    if (adaptation_) publish_levels(sample.header);
  }

 private:
  void publish_levels(const msg::Header& header) {
    msg::Adaptation sample{};
    sample.header = header;
    for (std::size_t i = 0; i < std::size(sample.axis); ++i) {
      const auto& used = friction_[i];
      auto& axis = sample.axis[i];
      axis.positive.used_coulomb_v = used.coulomb_positive_v;
      axis.positive.used_viscous_v = used.viscous_positive_vspm;
      axis.positive.used_static_v = used.stiction_positive_v;
      axis.negative.used_coulomb_v = used.coulomb_negative_v;
      axis.negative.used_viscous_v = used.viscous_negative_vspm;
      axis.negative.used_static_v = used.stiction_negative_v;
    }
    adaptation_->publish(sample);
  }

  std::array<control::DriveFriction, control::kAxes> friction_;
  runtime::Output<msg::Demand> output_;
  std::optional<runtime::Output<msg::Adaptation>> adaptation_;  ///< nothing: the rig file adapts no axis
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
