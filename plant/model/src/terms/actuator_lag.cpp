#include <cmath>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

/// First-order lag. The output is the mean of the exact response over the tick: the drive then has the exact
/// speed at the end of the tick.
class Pole {
 public:
  explicit Pole(double time_constant_s) : time_constant_s_(time_constant_s) {}
  double mean_of(double input_v, double period_s) {
    const double missing_v = output_v_ - input_v, kept = std::exp(-period_s / time_constant_s_);
    output_v_ = input_v + missing_v * kept;
    return input_v + missing_v * (time_constant_s_ / period_s) * (1 - kept);
  }

 private:
  double time_constant_s_;
  double output_v_ = 0;  // output at the end of the last tick
};

class ActuatorLag final : public Term {
 public:
  explicit ActuatorLag(const TermSetting& s)
      : axis_(drive_axis(s.axis)),
        first_(s.parameters.at("time_constant_s")),
        second_(s.parameters.at("second_s")) {}

  void change_command(PerAxis& drive_v, double period_s) noexcept override {
    drive_v[axis_] = second_.mean_of(first_.mean_of(drive_v[axis_], period_s), period_s);
  }

 private:
  Axis axis_;
  Pole first_, second_;
};

}  // namespace

TermKind actuator_lag() {
  return {
      .name = "actuator_lag",
      .equation =
          "tau V_1' = V_command - V_1, tau_2 V' = V_1 - V, each averaged over each tick; tau_2 = 0: one lag",
      .effect =
          "a current loop or a filter between converter and motor delays the voltage; tau_2 > 0: two lags in "
          "series",
      .acts_on = ActsOn::command,
      .axes = {"trolley", "slew", "hoist"},
      .parameters = {{"time_constant_s", "s", 0, 0, 2, "tau, time constant of the first lag"},
                     {"second_s", "s", 0, 0, 2, "tau_2, time constant of the second lag; 0: no second lag"}},
      .example = {"actuator_lag", "slew", {{"time_constant_s", 0.05}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<ActuatorLag>(s); }};
}

}  // namespace crane::plant
