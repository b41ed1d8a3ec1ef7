#include <cmath>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class StribeckFriction final : public Term {
 public:
  explicit StribeckFriction(const TermSetting& s)
      : excess_v_(s.parameters.at("excess_v")),
        decay_speed_(s.parameters.at("decay_speed")),
        exponent_(s.parameters.at("exponent")),
        smoothing_speed_(s.parameters.at("smoothing_speed")) {}

  void add_friction(const DriveMotion& drive, double& friction_v) const noexcept override {
    const double ratio = std::abs(drive.speed) / decay_speed_;
    const double power = exponent_ == 2 ? ratio * ratio : std::pow(ratio, exponent_);
    friction_v += excess_v_ * std::exp(-power) * drive.smooth_sign(smoothing_speed_);
  }

 private:
  double excess_v_, decay_speed_, exponent_, smoothing_speed_;
};

}  // namespace

TermKind stribeck_friction() {
  return {.name = "stribeck_friction",
          .equation = "f = a exp(-(|v|/v_d)^d) tanh(v/v_s)",
          .effect =
              "the friction at low speed exceeds the Coulomb friction (Armstrong-Helouvry, Dupont, Canudas "
              "de Wit, Automatica 30 (1994) 1083; d = 2: Gaussian form, d = 1: exponential form)",
          .acts_on = ActsOn::drive,
          .axes = {"trolley", "slew", "hoist"},
          .parameters = {{"excess_v", "V", 0, 0, 10, "a, excess over Coulomb friction at low speed"},
                         {"decay_speed", "m/s or rad/s", 0.05, 1e-3, 10,
                          "v_d, speed at which the excess has decayed to 37 %"},
                         {"exponent", "1", 2, 0.5, 4, "d, form of the decay"},
                         {"smoothing_speed", "m/s or rad/s", 0.0005, 1e-6, 0.1,
                          "v_s, width of the step at v = 0"}},
          .example = {"stribeck_friction", "slew", {{"excess_v", 0.3}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<StribeckFriction>(s);
          }};
}

}  // namespace crane::plant
