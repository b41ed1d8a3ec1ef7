#include "crane/plant/term.hpp"
#include "terms/swing_channels.hpp"

namespace crane::plant {
namespace {

class SwingScale final : public Term {
 public:
  explicit SwingScale(const TermSetting& s) : axis_(s.axis), factor_(s.parameters.at("factor")) {}

  void change_measurement(Measurement& measured, double /*period_s*/) noexcept override {
    for_each_swing(axis_, measured, [this](double& angle_rad, std::size_t) { angle_rad *= factor_; });
  }

 private:
  SwingAxes axis_;
  double factor_;
};

}  // namespace

TermKind swing_scale() {
  return {
      .name = "swing_scale",
      .equation = "phi_measured = k phi",
      .effect = "counts per turn or gear ratio of a swing encoder differs from the value in the rig file",
      .acts_on = ActsOn::sensor,
      .axes = {"radial", "tangential"},
      .parameters = {{"factor", "1", 1, 0.1, 10, "k, measured / true angle"}},
      .example = {"swing_scale", "tangential", {{"factor", 1.1}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<SwingScale>(s); }};
}

}  // namespace crane::plant
