#include <cmath>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class DirectionAsymmetry final : public Term {
 public:
  explicit DirectionAsymmetry(const TermSetting& s)
      : coulomb_v_(s.parameters.at("coulomb_v")),
        viscous_vspm_(s.parameters.at("viscous_vspm")),
        smoothing_speed_(s.parameters.at("smoothing_speed")) {}

  void add_friction(const DriveMotion& drive, double& friction_v) const noexcept override {
    friction_v +=
        coulomb_v_ * std::abs(drive.smooth_sign(smoothing_speed_)) + viscous_vspm_ * std::abs(drive.speed);
  }

 private:
  double coulomb_v_, viscous_vspm_, smoothing_speed_;
};

}  // namespace

TermKind direction_asymmetry() {
  return {
      .name = "direction_asymmetry",
      .equation =
          "f = c tanh(|v|/v_s) + b |v|; the friction that opposes the motion is larger by c + b |v| for v > "
          "0 and smaller by the same amount for v < 0",
      .effect =
          "the difference between the friction (3.1) of the two directions differs from that of the rig file",
      .acts_on = ActsOn::drive,
      .axes = {"trolley", "slew", "hoist"},
      .parameters = {{"coulomb_v", "V", 0, -10, 10,
                      "c / K_m, Coulomb friction added for v > 0, subtracted for v < 0"},
                     {"viscous_vspm", "V s/m or V s/rad", 0, -1000, 1000,
                      "b / K_m, viscous friction added for v > 0, subtracted for v < 0"},
                     {"smoothing_speed", "m/s or rad/s", 0.0005, 1e-6, 0.1,
                      "v_s, width of the step at v = 0"}},
      .example = {"direction_asymmetry", "trolley", {{"coulomb_v", 0.1}, {"viscous_vspm", 0.3}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
        return std::make_unique<DirectionAsymmetry>(s);
      }};
}

}  // namespace crane::plant
