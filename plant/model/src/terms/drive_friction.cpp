#include <algorithm>
#include <cmath>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class DriveFriction final : public Term {
 public:
  explicit DriveFriction(const TermSetting& s)
      : positive_{s, "positive"},
        negative_{s, "negative"},
        stiction_speed_(s.parameters.at("stiction_speed")),
        smoothing_speed_(s.parameters.at("smoothing_speed")) {}

  void add_friction(const DriveMotion& drive, double& friction_v) const noexcept override {
    const double v = drive.speed;
    const Direction& d = v >= 0 ? positive_ : negative_;
    double level_v = d.coulomb_v;
    if (d.excess_v > 0) level_v += d.excess_v * std::exp(-v * v / (stiction_speed_ * stiction_speed_));
    friction_v += level_v * drive.smooth_sign(smoothing_speed_) + d.viscous_vspm * v;
  }

 private:
  struct Direction {
    Direction(const TermSetting& s, const std::string& sign)
        : viscous_vspm(s.parameters.at("viscous_" + sign + "_vspm")),
          coulomb_v(s.parameters.at("coulomb_" + sign + "_v")),
          excess_v(std::max(0.0, s.parameters.at("stiction_" + sign + "_v") - coulomb_v)) {}
    double viscous_vspm, coulomb_v, excess_v;
  };
  Direction positive_, negative_;
  double stiction_speed_, smoothing_speed_;
};

}  // namespace

TermKind drive_friction() {
  return {
      .name = "drive_friction",
      .equation =
          "f = (c + max(0, s - c) exp(-(v/v_st)^2)) tanh(v/v_s) + b v, with b, c, s of the direction of v",
      .effect =
          "the drive has the friction (3.1), smoothed at v = 0; the break-away excess s - c decays with the "
          "speed",
      .acts_on = ActsOn::drive,
      .axes = {"trolley", "slew", "hoist"},
      .parameters =
          {{"viscous_positive_vspm", "V s/m or V s/rad", 0, 0, 1000, "b+ / K_m, viscous friction for v > 0"},
           {"viscous_negative_vspm", "V s/m or V s/rad", 0, 0, 1000, "b- / K_m, viscous friction for v < 0"},
           {"coulomb_positive_v", "V", 0, 0, 10, "c+ / K_m, Coulomb friction for v > 0"},
           {"coulomb_negative_v", "V", 0, 0, 10, "c- / K_m, Coulomb friction for v < 0"},
           {"stiction_positive_v", "V", 0, 0, 10,
            "s+ / K_m, break-away friction for v > 0; no effect below c+"},
           {"stiction_negative_v", "V", 0, 0, 10,
            "s- / K_m, break-away friction for v < 0; no effect below c-"},
           {"stiction_speed", "m/s or rad/s", 0.005, 1e-4, 1,
            "v_st, speed at which the excess s - c has decayed to 37 %"},
           {"smoothing_speed", "m/s or rad/s", 0.0005, 1e-6, 0.1, "v_s, width of the step at v = 0"}},
      .example = {"drive_friction", "trolley", {{"coulomb_positive_v", 0.5}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
        return std::make_unique<DriveFriction>(s);
      }};
}

}  // namespace crane::plant
