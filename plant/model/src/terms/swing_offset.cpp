#include "crane/plant/term.hpp"
#include "terms/swing_channels.hpp"

namespace crane::plant {
namespace {

class SwingOffset final : public Term {
 public:
  explicit SwingOffset(const TermSetting& s) : axis_(s.axis), offset_rad_(s.parameters.at("offset_rad")) {}

  void change_measurement(Measurement& measured, double /*period_s*/) noexcept override {
    for_each_swing(axis_, measured, [this](double& angle_rad, std::size_t) { angle_rad += offset_rad_; });
  }

 private:
  SwingAxes axis_;
  double offset_rad_;
};

}  // namespace

TermKind swing_offset() {
  return {
      .name = "swing_offset",
      .equation = "phi_measured = phi + d",
      .effect = "a swing encoder was not zeroed with the load at rest",
      .acts_on = ActsOn::sensor,
      .axes = {"radial", "tangential"},
      .parameters = {{"offset_rad", "rad", 0, -0.5, 0.5, "d, measured angle at phi = 0"}},
      .example = {"swing_offset", "radial", {{"offset_rad", 0.01}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<SwingOffset>(s); }};
}

}  // namespace crane::plant
