#include <cmath>
#include <numbers>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class PositionDependentFriction final : public Term {
 public:
  explicit PositionDependentFriction(const TermSetting& s)
      : amplitude_v_(s.parameters.at("amplitude_v")),
        wave_number_(2 * std::numbers::pi / s.parameters.at("wavelength")),
        tight_at_(s.parameters.at("tight_at")),
        smoothing_speed_(s.parameters.at("smoothing_speed")) {}

  void add_friction(const DriveMotion& drive, double& friction_v) const noexcept override {
    const double tightness = 0.5 * (1 + std::cos(wave_number_ * (drive.position - tight_at_)));
    friction_v += amplitude_v_ * tightness * drive.smooth_sign(smoothing_speed_);
  }

 private:
  double amplitude_v_, wave_number_, tight_at_, smoothing_speed_;
};

}  // namespace

TermKind position_dependent_friction() {
  return {.name = "position_dependent_friction",
          .equation = "f = a (1 + cos(2 pi (p - p_0) / w)) / 2 tanh(v/v_s)",
          .effect =
              "a bent guide or an eccentric gear adds friction: most at the tight spots p_0 + n w, none "
              "midway between two tight spots",
          .acts_on = ActsOn::drive,
          .axes = {"trolley", "slew", "hoist"},
          .parameters = {{"amplitude_v", "V", 0, 0, 10, "a, friction that a tight spot adds"},
                         {"wavelength", "m or rad", 1, 1e-3, 100, "w, distance between tight spots"},
                         {"tight_at", "m or rad", 0, -100, 100, "p_0, position of one tight spot"},
                         {"smoothing_speed", "m/s or rad/s", 0.0005, 1e-6, 0.1,
                          "v_s, width of the step at v = 0"}},
          .example = {"position_dependent_friction", "trolley", {{"amplitude_v", 0.3}, {"wavelength", 0.2}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<PositionDependentFriction>(s);
          }};
}

}  // namespace crane::plant
