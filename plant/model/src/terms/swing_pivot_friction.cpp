#include <cmath>

#include "crane/plant/smooth_sign.hpp"
#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class SwingPivotFriction final : public Term {
 public:
  explicit SwingPivotFriction(const TermSetting& s)
      : radial_(s.axis != "tangential"),
        tangential_(s.axis != "radial"),
        viscous_nmsprad_(s.parameters.at("viscous_nmsprad")),
        coulomb_nm_(s.parameters.at("coulomb_nm")),
        smoothing_radps_(s.parameters.at("smoothing_radps")) {}

  void add_force(const Parameters& /*crane*/, const State& state, const motion::Angles<double>& /*cable*/,
                 Forces& sum) const noexcept override {
    if (radial_) sum.radial_nm -= torque_nm(state.radial_radps);
    if (tangential_) sum.tangential_nm -= torque_nm(state.tangential_radps);
  }

 private:
  [[nodiscard]] double torque_nm(double rate_radps) const {
    return viscous_nmsprad_ * rate_radps + coulomb_nm_ * smooth_sign(rate_radps, smoothing_radps_);
  }
  bool radial_, tangential_;
  double viscous_nmsprad_, coulomb_nm_, smoothing_radps_;
};

}  // namespace

TermKind swing_pivot_friction() {
  return {.name = "swing_pivot_friction",
          .equation = "Q = -(b w + c tanh(w/w_s)), w = phi' or theta'",
          .effect = "the bearings of the upper cable joint, at the swing encoders, have friction",
          .acts_on = ActsOn::load,
          .axes = {"radial", "tangential", ""},
          .parameters = {{"viscous_nmsprad", "N m s/rad", 0, 0, 1e8, "b, viscous friction"},
                         {"coulomb_nm", "N m", 0, 0, 1e8, "c, Coulomb friction"},
                         {"smoothing_radps", "rad/s", 0.01, 1e-6, 1, "w_s, width of the step at w = 0"}},
          .example = {"swing_pivot_friction", "", {{"coulomb_nm", 0.02}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<SwingPivotFriction>(s);
          }};
}

}  // namespace crane::plant
