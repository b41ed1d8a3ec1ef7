#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class CommandOffset final : public Term {
 public:
  explicit CommandOffset(const TermSetting& s)
      : axis_(drive_axis(s.axis)), offset_v_(s.parameters.at("offset_v")) {}

  void change_command(PerAxis& drive_v, double /*period_s*/) noexcept override {
    drive_v[axis_] += offset_v_;
  }

 private:
  Axis axis_;
  double offset_v_;
};

}  // namespace

TermKind command_offset() {
  return {.name = "command_offset",
          .equation = "V = V_command + d",
          .effect = "the converter or the amplifier has a zero error",
          .acts_on = ActsOn::command,
          .axes = {"trolley", "slew", "hoist"},
          .parameters = {{"offset_v", "V", 0, -10, 10, "d, added voltage"}},
          .example = {"command_offset", "slew", {{"offset_v", 0.1}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<CommandOffset>(s);
          }};
}

}  // namespace crane::plant
