#include <cmath>

#include "crane/plant/term.hpp"
#include "terms/structure.hpp"

namespace crane::plant {
namespace {

class CableElasticity final : public Term {
 public:
  explicit CableElasticity(const TermSetting& s)
      : compliance_mpn_(s.parameters.at("compliance_mpn")),
        damping_ratio_(s.parameters.at("damping_ratio")),
        unmeasured_stretch_(s.parameters.at("unmeasured_stretch")) {}

  [[nodiscard]] std::size_t inner_coordinates() const noexcept override {
    return compliance_mpn_ > 0 ? 1 : 0;
  }
  [[nodiscard]] Displacement rest_displacement(const Parameters& crane) const noexcept override {
    return {.cable_m = unmeasured_stretch_ * compliance_mpn_ * crane.load_mass_kg * crane.gravity_mps2};
  }
  void displace(const double* inner, Displacement& sum) const noexcept override {
    if (compliance_mpn_ > 0) sum.cable_m += inner[0];
  }
  void add_inner_motion(const Parameters& crane, const State& state, const motion::Angles<double>& cable,
                        const Inner* inner, Forces& /*sum*/,
                        InnerEquation* equations) const noexcept override {
    const double inertia = compliance_mpn_ * crane.load_mass_kg;  // c m = 1 / omega^2
    if (inertia * kRigid_radps2 < 1) return;
    const CableTension tension = cable_tension(crane, state, cable);
    const double m = crane.load_mass_kg;
    equations[0] = {.free = tension.free_n / m - crane.gravity_mps2 - inner[0].position / inertia -
                            2 * damping_ratio_ / std::sqrt(inertia) * inner[0].rate,
                    .by_trolley = tension.by_trolley_kg / m,
                    .by_slew = tension.by_slew_kgm / m,
                    .by_cable = tension.by_cable_kg / m};
  }

 private:
  double compliance_mpn_, damping_ratio_, unmeasured_stretch_;
};

}  // namespace

TermKind cable_elasticity() {
  return {
      .name = "cable_elasticity",
      .equation =
          "the load hangs at L + u c m g + s, s'' = T/m - g - s/(c m) - 2 z s'/sqrt(c m), T the tension of "
          "the rigid cable",
      .effect = "the cable stretches by Hooke's law; s is the stretch minus the stretch by the load at rest",
      .acts_on = ActsOn::structure,
      .axes = {""},
      .parameters = {{"compliance_mpn", "m/N", 0, 0, 0.1,
                      "c, stretch per force; a cable with a natural frequency above 12 Hz is rigid"},
                     {"damping_ratio", "1", 0.02, 0, 1, "z, damping ratio of the vertical oscillation"},
                     {"unmeasured_stretch", "1", 0, 0, 1,
                      "u, share of the stretch at rest that the measured length does not include"}},
      .example = {"cable_elasticity", "", {{"compliance_mpn", 0.002}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
        return std::make_unique<CableElasticity>(s);
      }};
}

}  // namespace crane::plant
