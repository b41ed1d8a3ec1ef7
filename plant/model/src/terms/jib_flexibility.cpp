#include <cmath>

#include "crane/plant/term.hpp"
#include "terms/far_side.hpp"
#include "terms/structure.hpp"

namespace crane::plant {
namespace {

class JibFlexibility final : public Term {
 public:
  explicit JibFlexibility(const TermSetting& s)
      : compliance_s2_(s.parameters.at("compliance_s2")),
        damping_ratio_(s.parameters.at("damping_ratio")),
        rigid_(compliance_s2_ < 1 / kRigid_radps2),
        far_(true, rigid_ ? 0 : s.parameters.at("jib_share")) {}

  void change_parameters(Parameters& crane) const noexcept override { far_.split(crane); }
  [[nodiscard]] std::size_t inner_coordinates() const noexcept override { return rigid_ ? 0 : 1; }
  void displace(const double* inner, Displacement& sum) const noexcept override {
    if (!rigid_) sum.slew_rad += inner[0];
  }
  void add_inner_motion(const Parameters& crane, const State& state, const motion::Angles<double>& cable,
                        const Inner* inner, Forces& sum, InnerEquation* equations) const noexcept override {
    if (rigid_) return;
    const double spring = spring_radps2(inner[0]), load_nm = far_.load_force(crane, state, cable);
    far_.add_motor_reaction(crane, spring, load_nm, sum);
    equations[0] = {.free = far_.acceleration(crane, state, spring, load_nm), .by_slew = -1};
  }

 private:
  [[nodiscard]] double spring_radps2(const Inner& inner) const {
    return -inner.position / compliance_s2_ - 2 * damping_ratio_ / std::sqrt(compliance_s2_) * inner.rate;
  }
  double compliance_s2_, damping_ratio_;
  bool rigid_;
  FarSide far_;
};

}  // namespace

TermKind jib_flexibility() {
  return {
      .name = "jib_flexibility",
      .equation =
          "suspension point at gamma + d, d'' = k - gamma'', k = -d/c - 2 z d'/sqrt(c); for j > 0 the spring "
          "turns j J_o and the trolley, d'' = (j J_o k + P - C) / (j J_o + M_j x^2) - gamma''; inertia of "
          "the "
          "motor (1 - j) J_o, torque on the motor -(j J_o k + P)",
      .effect =
          "the jib bends sideways (first mode); with a fixed root, its natural frequency is 1 / (2 pi "
          "sqrt(c))",
      .acts_on = ActsOn::structure,
      .axes = {""},
      .parameters =
          {{"compliance_s2", "s2", 0, 0, 0.3,
            "c, deflection per angular acceleration; a jib with a natural frequency above 12 Hz is rigid"},
           {"damping_ratio", "1", 0.02, 0, 1, "z, damping ratio of the bending mode"},
           {"jib_share", "1", 0, 0, 0.9, "j, inertia on the load side of the spring / J_o"}},
      .example = {"jib_flexibility", "", {{"compliance_s2", 0.003}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
        return std::make_unique<JibFlexibility>(s);
      }};
}

}  // namespace crane::plant
