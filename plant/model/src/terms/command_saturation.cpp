#include <algorithm>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class CommandSaturation final : public Term {
 public:
  explicit CommandSaturation(const TermSetting& s)
      : axis_(drive_axis(s.axis)), limit_v_(s.parameters.at("limit_v")) {}

  void change_command(PerAxis& drive_v, double /*period_s*/) noexcept override {
    if (limit_v_ > 0) drive_v[axis_] = std::clamp(drive_v[axis_], -limit_v_, limit_v_);
  }

 private:
  Axis axis_;
  double limit_v_;
};

}  // namespace

TermKind command_saturation() {
  return {.name = "command_saturation",
          .equation = "V = max(-V_max, min(V_max, V_command))",
          .effect =
              "the supply voltage or the current limit of the amplifier limits its output below the range of "
              "the command",
          .acts_on = ActsOn::command,
          .axes = {"trolley", "slew", "hoist"},
          .parameters = {{"limit_v", "V", 0, 0, 1000, "V_max, largest output; 0: no limit"}},
          .example = {"command_saturation", "slew", {{"limit_v", 1.5}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<CommandSaturation>(s);
          }};
}

}  // namespace crane::plant
