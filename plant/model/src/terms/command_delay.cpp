#include "crane/plant/term.hpp"
#include "terms/sample_history.hpp"

namespace crane::plant {
namespace {

/// With a delay of a fraction of a tick, the previous command acts for this fraction. The output is the mean
/// over the tick: the drive then has the exact speed at the end of the tick.
class CommandDelay final : public Term {
 public:
  explicit CommandDelay(const TermSetting& s)
      : axis_(drive_axis(s.axis)), delay_s_(s.parameters.at("delay_s")) {}

  void change_command(PerAxis& drive_v, double period_s) noexcept override {
    past_v_.push(drive_v[axis_]);
    drive_v[axis_] = past_v_.before(delay_s_ / period_s);
  }

 private:
  Axis axis_;
  double delay_s_;
  SampleHistory past_v_;
};

}  // namespace

TermKind command_delay() {
  return {.name = "command_delay",
          .equation =
              "V(t) = V_command(t - tau), averaged over each tick; in addition to the delay of one tick of "
              "the loop",
          .effect = "bus, converter or amplifier delays the command",
          .acts_on = ActsOn::command,
          .axes = {"trolley", "slew", "hoist"},
          .parameters = {{"delay_s", "s", 0, 0, 0.5, "tau, delay"}},
          .example = {"command_delay", "trolley", {{"delay_s", 0.033}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<CommandDelay>(s);
          }};
}

}  // namespace crane::plant
