#include <algorithm>
#include <cmath>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class CommandDeadZone final : public Term {
 public:
  explicit CommandDeadZone(const TermSetting& s)
      : axis_(drive_axis(s.axis)), width_v_(s.parameters.at("width_v")) {}

  void change_command(PerAxis& drive_v, double /*period_s*/) noexcept override {
    double& v = drive_v[axis_];
    v = std::copysign(std::max(0.0, std::abs(v) - width_v_), v);
  }

 private:
  Axis axis_;
  double width_v_;
};

}  // namespace

TermKind command_dead_zone() {
  return {.name = "command_dead_zone",
          .equation = "V = sign(V_command) max(0, |V_command| - w)",
          .effect = "the amplifier or the converter has no output for small inputs",
          .acts_on = ActsOn::command,
          .axes = {"trolley", "slew", "hoist"},
          .parameters = {{"width_v", "V", 0, 0, 10,
                          "w, half the width: the output is 0 for inputs between -w and w"}},
          .example = {"command_dead_zone", "trolley", {{"width_v", 0.2}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<CommandDeadZone>(s);
          }};
}

}  // namespace crane::plant
