#include <cmath>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class SwingMisalignment final : public Term {
 public:
  explicit SwingMisalignment(const TermSetting& s)
      : sine_(std::sin(s.parameters.at("angle_rad"))), cosine_(std::cos(s.parameters.at("angle_rad"))) {}

  void change_measurement(Measurement& measured, double /*period_s*/) noexcept override {
    const double radial_rad = measured.radial_rad, tangential_rad = measured.tangential_rad;
    measured.radial_rad = cosine_ * radial_rad + sine_ * tangential_rad;
    measured.tangential_rad = cosine_ * tangential_rad - sine_ * radial_rad;
  }

 private:
  double sine_, cosine_;
};

}  // namespace

TermKind swing_misalignment() {
  return {.name = "swing_misalignment",
          .equation = "phi_measured = phi cos(a) + theta sin(a), theta_measured = theta cos(a) - phi sin(a)",
          .effect = "the fork of the swing encoders is rotated relative to the jib about the vertical axis",
          .acts_on = ActsOn::sensor,
          .axes = {""},
          .parameters = {{"angle_rad", "rad", 0, -0.8, 0.8, "a, angle of the rotation"}},
          .example = {"swing_misalignment", "", {{"angle_rad", 0.1}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<SwingMisalignment>(s);
          }};
}

}  // namespace crane::plant
