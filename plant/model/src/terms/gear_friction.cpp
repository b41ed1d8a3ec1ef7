#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class GearFriction final : public Term {
 public:
  explicit GearFriction(const TermSetting& s)
      : share_(s.parameters.at("share")), smoothing_speed_(s.parameters.at("smoothing_speed")) {}

  [[nodiscard]] bool has_gear_friction() const noexcept override { return true; }
  void add_gear_friction(const DriveMotion& drive, double carried_v,
                         double& friction_v) const noexcept override {
    friction_v += share_ * carried_v * drive.smooth_sign(smoothing_speed_);
  }

 private:
  double share_, smoothing_speed_;
};

}  // namespace

TermKind gear_friction() {
  return {
      .name = "gear_friction",
      .equation =
          "f = mu |V - P| tanh(v/v_s), V: output of the amplifier, P: volts of the terms position_force and "
          "torque_ripple of the axis",
      .effect =
          "the friction of gear teeth increases with the transmitted force (M. Duclusaud et al., Extended "
          "friction models for the physics simulation of servo actuators, ICRA 2025, model M3)",
      .acts_on = ActsOn::drive,
      .axes = {"trolley", "slew", "hoist"},
      .parameters = {{"share", "1", 0, 0, 0.95, "mu, friction / transmitted force"},
                     {"smoothing_speed", "m/s or rad/s", 0.0005, 1e-6, 0.1,
                      "v_s, width of the step at v = 0"}},
      .example = {"gear_friction", "slew", {{"share", 0.3}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
        return std::make_unique<GearFriction>(s);
      }};
}

}  // namespace crane::plant
