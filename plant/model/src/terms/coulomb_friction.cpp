#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class CoulombFriction final : public Term {
 public:
  explicit CoulombFriction(const TermSetting& s)
      : level_v_(s.parameters.at("level_v")), smoothing_speed_(s.parameters.at("smoothing_speed")) {}

  void add_friction(const DriveMotion& drive, double& friction_v) const noexcept override {
    friction_v += level_v_ * drive.smooth_sign(smoothing_speed_);
  }

 private:
  double level_v_, smoothing_speed_;
};

}  // namespace

TermKind coulomb_friction() {
  return {.name = "coulomb_friction",
          .equation = "f = c tanh(v/v_s), the same in both directions, in addition to drive_friction",
          .effect = "the Coulomb friction (3.1) differs from that of the rig file",
          .acts_on = ActsOn::drive,
          .axes = {"trolley", "slew", "hoist"},
          .parameters = {{"level_v", "V", 0, -10, 10,
                          "c / K_m, added Coulomb friction; negative: less friction than in the rig file"},
                         {"smoothing_speed", "m/s or rad/s", 0.0005, 1e-6, 0.1,
                          "v_s, width of the step at v = 0"}},
          .example = {"coulomb_friction", "slew", {{"level_v", 0.2}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<CoulombFriction>(s);
          }};
}

}  // namespace crane::plant
