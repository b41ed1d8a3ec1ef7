#include <cmath>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

/// The output is the mean of the exact response over the tick, which gives the drive the same speed at its
/// end.
class ActuatorLag final : public Term {
 public:
  explicit ActuatorLag(const TermSetting& s)
      : axis_(drive_axis(s.axis)), time_constant_s_(s.parameters.at("time_constant_s")) {}

  void change_command(PerAxis& drive_v, double period_s) noexcept override {
    const double command_v = drive_v[axis_], missing_v = output_v_ - command_v;
    const double kept = std::exp(-period_s / time_constant_s_);
    drive_v[axis_] = command_v + missing_v * (time_constant_s_ / period_s) * (1 - kept);
    output_v_ = command_v + missing_v * kept;
  }

 private:
  Axis axis_;
  double time_constant_s_;
  double output_v_ = 0;  // at the end of the last tick
};

}  // namespace

TermKind actuator_lag() {
  return {
      .name = "actuator_lag",
      .equation = "tau V' = V_command - V",
      .source = "current loop or filter between converter and motor, first order",
      .acts_on = ActsOn::command,
      .axes = {"trolley", "slew", "hoist"},
      .parameters = {{"time_constant_s", "s", 0, 0, 2, "tau"}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<ActuatorLag>(s); }};
}

}  // namespace crane::plant
