#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class ViscousFriction final : public Term {
 public:
  explicit ViscousFriction(const TermSetting& s) : vspm_(s.parameters.at("vspm")) {}

  void add_friction(const DriveMotion& drive, double& friction_v) const noexcept override {
    friction_v += vspm_ * drive.speed;
  }

 private:
  double vspm_;
};

}  // namespace

TermKind viscous_friction() {
  return {.name = "viscous_friction",
          .equation = "f = b v, the same in both directions, in addition to drive_friction",
          .effect = "the viscous friction (3.1) differs from that of the rig file",
          .acts_on = ActsOn::drive,
          .axes = {"trolley", "slew", "hoist"},
          .parameters = {{"vspm", "V s/m or V s/rad", 0, -1000, 1000,
                          "b / K_m, added viscous friction; negative: less friction than in the rig file"}},
          .example = {"viscous_friction", "trolley", {{"vspm", 0.5}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<ViscousFriction>(s);
          }};
}

}  // namespace crane::plant
