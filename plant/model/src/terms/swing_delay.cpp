#include "crane/plant/term.hpp"
#include "terms/sample_history.hpp"
#include "terms/swing_channels.hpp"

namespace crane::plant {
namespace {

class SwingDelay final : public Term {
 public:
  explicit SwingDelay(const TermSetting& s) : axis_(s.axis), delay_s_(s.parameters.at("delay_s")) {}

  void change_measurement(Measurement& measured, double period_s) noexcept override {
    for_each_swing(axis_, measured, [&](double& angle_rad, std::size_t i) {
      if (!begun_) past_rad_[i].fill(angle_rad);
      past_rad_[i].push(angle_rad);
      angle_rad = past_rad_[i].before(delay_s_ / period_s);
    });
    begun_ = true;
  }

 private:
  SwingAxes axis_;
  double delay_s_;
  std::array<SampleHistory, 2> past_rad_;
  bool begun_ = false;
};

}  // namespace

TermKind swing_delay() {
  return {
      .name = "swing_delay",
      .equation = "phi_measured(t) = phi(t - tau), interpolated linearly between ticks",
      .effect = "camera, radio link or serial converter delays the measured swing",
      .acts_on = ActsOn::sensor,
      .axes = {"radial", "tangential", ""},
      .parameters = {{"delay_s", "s", 0, 0, 0.5, "tau, delay"}},
      .example = {"swing_delay", "radial", {{"delay_s", 0.025}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<SwingDelay>(s); }};
}

}  // namespace crane::plant
