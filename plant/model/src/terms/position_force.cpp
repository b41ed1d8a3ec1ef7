#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class PositionForce final : public Term {
 public:
  explicit PositionForce(const TermSetting& s)
      : stiffness_vpm_(s.parameters.at("stiffness_vpm")), offset_v_(s.parameters.at("offset_v")) {}

  void add_friction(const DriveMotion& drive, double& friction_v) const noexcept override {
    friction_v -= position_force_v(drive.position);
  }
  [[nodiscard]] double position_force_v(double position) const noexcept override {
    return offset_v_ - stiffness_vpm_ * position;
  }

 private:
  double stiffness_vpm_, offset_v_;
};

}  // namespace

TermKind position_force() {
  return {.name = "position_force",
          .equation = "f = k p - o: the drive gets V - k p + o, a spring at rest at p = o / k",
          .effect = "a cable, hose or spring pulls the axis back (k > 0), or the axis is not balanced",
          .acts_on = ActsOn::drive,
          .axes = {"trolley", "slew", "hoist"},
          .parameters = {{"stiffness_vpm", "V/m or V/rad", 0, -1000, 1000, "k / K_m, stiffness"},
                         {"offset_v", "V", 0, -10, 10, "o / K_m, force at position 0"}},
          .example = {"position_force", "trolley", {{"stiffness_vpm", 0.5}, {"offset_v", 0.1}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<PositionForce>(s);
          }};
}

}  // namespace crane::plant
