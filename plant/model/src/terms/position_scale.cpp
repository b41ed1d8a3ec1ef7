#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class PositionScale final : public Term {
 public:
  explicit PositionScale(const TermSetting& s)
      : slew_(s.axis == "slew"), factor_(s.parameters.at("factor")) {}

  void change_measurement(Measurement& measured, double /*period_s*/) noexcept override {
    (slew_ ? measured.slew_rad : measured.trolley_m) *= factor_;
  }

 private:
  bool slew_;
  double factor_;
};

}  // namespace

TermKind position_scale() {
  return {.name = "position_scale",
          .equation = "p_measured = k p",
          .effect = "pitch, gear ratio or wheel diameter of a drive differs from the value in the rig file",
          .acts_on = ActsOn::sensor,
          .axes = {"trolley", "slew"},
          .parameters = {{"factor", "1", 1, 0.1, 10, "k, measured / true position"}},
          .example = {"position_scale", "slew", {{"factor", 1.02}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<PositionScale>(s);
          }};
}

}  // namespace crane::plant
