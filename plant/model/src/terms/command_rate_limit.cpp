#include <algorithm>
#include <cmath>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

/// The output is a ramp until it reaches the command. The output of the term is the mean over the tick: the
/// drive then has the exact speed at the end of the tick.
class CommandRateLimit final : public Term {
 public:
  explicit CommandRateLimit(const TermSetting& s)
      : axis_(drive_axis(s.axis)), rate_vps_(s.parameters.at("rate_vps")) {}

  void change_command(PerAxis& drive_v, double period_s) noexcept override {
    if (!(rate_vps_ > 0)) return;
    double& v = drive_v[axis_];
    const double missing_v = v - output_v_, ramp_v = std::min(std::abs(missing_v), rate_vps_ * period_s),
                 ramp_s = ramp_v / rate_vps_;
    const double end_v = output_v_ + std::copysign(ramp_v, missing_v);
    v = end_v - std::copysign(0.5 * ramp_v * ramp_s / period_s, missing_v);
    output_v_ = end_v;
  }

 private:
  Axis axis_;
  double rate_vps_;
  double output_v_ = 0;  // output at the end of the last tick
};

}  // namespace

TermKind command_rate_limit() {
  return {
      .name = "command_rate_limit",
      .equation =
          "V(t + dt) = V(t) + max(-r dt, min(r dt, V_command - V(t))); the output is the mean over each tick",
      .effect =
          "the ramp of a frequency converter or the slew rate of an amplifier limits the rate of the output",
      .acts_on = ActsOn::command,
      .axes = {"trolley", "slew", "hoist"},
      .parameters = {{"rate_vps", "V/s", 0, 0, 1e6, "r, largest rate of the output; 0: no limit"}},
      .example = {"command_rate_limit", "trolley", {{"rate_vps", 8}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
        return std::make_unique<CommandRateLimit>(s);
      }};
}

}  // namespace crane::plant
