#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class DriveInertia final : public Term {
 public:
  explicit DriveInertia(const TermSetting& s)
      : axis_(drive_axis(s.axis)), factor_(s.parameters.at("factor")) {}

  void change_parameters(Parameters& crane) const noexcept override {
    (axis_ == kTrolley ? crane.trolley_inertia_kg : crane.jib_inertia_kgm2) *= factor_;
    (axis_ == kTrolley ? crane.trolley_gain_mps2pv : crane.slew_gain_radps2pv) /= factor_;
  }

 private:
  Axis axis_;
  double factor_;
};

}  // namespace

TermKind drive_inertia() {
  return {.name = "drive_inertia",
          .equation = "trolley: M = k M_rig_file, K_m = K_m_rig_file / k; slew: the same with J_o",
          .effect =
              "the drive accelerates another inertia than that of the rig file; its force per volt and its "
              "friction do not change",
          .acts_on = ActsOn::parameters,
          .axes = {"trolley", "slew"},
          .parameters = {{"factor", "1", 1, 0.05, 20, "k, true inertia / inertia of the rig file"}},
          .example = {"drive_inertia", "trolley", {{"factor", 1.15}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<DriveInertia>(s);
          }};
}

}  // namespace crane::plant
