#include <cmath>
#include <numbers>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class TorqueRipple final : public Term {
 public:
  explicit TorqueRipple(const TermSetting& s)
      : amplitude_v_(s.parameters.at("amplitude_v")),
        phase_rad_(s.parameters.at("phase_rad")),
        wave_number_(2 * std::numbers::pi / s.parameters.at("period")) {}

  void add_friction(const DriveMotion& drive, double& friction_v) const noexcept override {
    friction_v -= position_force_v(drive.position);
  }
  [[nodiscard]] double position_force_v(double position) const noexcept override {
    return amplitude_v_ * std::sin(wave_number_ * position + phase_rad_);
  }

 private:
  double amplitude_v_, phase_rad_, wave_number_;
};

}  // namespace

TermKind torque_ripple() {
  return {.name = "torque_ripple",
          .equation = "f = -a sin(2 pi p / w + psi): the drive gets V + a sin(2 pi p / w + psi)",
          .effect =
              "cogging of the motor or an eccentric gear causes a force that depends on the position, not on "
              "the direction",
          .acts_on = ActsOn::drive,
          .axes = {"trolley", "slew", "hoist"},
          .parameters = {{"amplitude_v", "V", 0, -10, 10, "a, amplitude"},
                         {"phase_rad", "rad", 0, -7, 7, "psi, phase at position 0"},
                         {"period", "m or rad", 0.1, 1e-3, 100, "w, distance between two maxima"}},
          .example = {"torque_ripple", "slew", {{"amplitude_v", 0.3}, {"period", 0.14}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<TorqueRipple>(s);
          }};
}

}  // namespace crane::plant
