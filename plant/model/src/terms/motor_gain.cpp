#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class MotorGain final : public Term {
 public:
  explicit MotorGain(const TermSetting& s) : axis_(drive_axis(s.axis)), factor_(s.parameters.at("factor")) {}

  void change_command(PerAxis& drive_v, double /*period_s*/) noexcept override { drive_v[axis_] *= factor_; }

 private:
  Axis axis_;
  double factor_;
};

}  // namespace

TermKind motor_gain() {
  return {
      .name = "motor_gain",
      .equation = "V = k V_command; friction forces do not change",
      .effect = "the gain of amplifier and motor differs from K_m of (2.10) in the rig file",
      .acts_on = ActsOn::command,
      .axes = {"trolley", "slew", "hoist"},
      .parameters = {{"factor", "1", 1, 0, 5, "k, true gain / gain of the rig file"}},
      .example = {"motor_gain", "trolley", {{"factor", 0.9}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<MotorGain>(s); }};
}

}  // namespace crane::plant
