#include <cmath>

#include "crane/plant/term.hpp"
#include "terms/structure.hpp"

namespace crane::plant {
namespace {

class JibFlexibility final : public Term {
 public:
  explicit JibFlexibility(const TermSetting& s)
      : compliance_s2_(s.parameters.at("compliance_s2")),
        damping_ratio_(s.parameters.at("damping_ratio")),
        rigid_(compliance_s2_ < 1 / kRigid_radps2) {}

  [[nodiscard]] std::size_t inner_coordinates() const noexcept override { return rigid_ ? 0 : 1; }
  void displace(const double* inner, Displacement& sum) const noexcept override {
    if (!rigid_) sum.slew_rad += inner[0];
  }
  void accelerate(const Parameters& /*crane*/, const State& /*state*/, const Accelerations& drives,
                  const Inner* inner, double* acceleration) const noexcept override {
    if (rigid_) return;
    acceleration[0] = -inner[0].position / compliance_s2_ -
                      2 * damping_ratio_ / std::sqrt(compliance_s2_) * inner[0].rate - drives.slew_radps2;
  }

 private:
  double compliance_s2_, damping_ratio_;
  bool rigid_;
};

}  // namespace

TermKind jib_flexibility() {
  return {.name = "jib_flexibility",
          .equation = "the load hangs at gamma + d, d'' = -d/c - 2 z d'/sqrt(c) - gamma''",
          .source = "first sideways bending mode of the jib, driven by its root; f = 1 / (2 pi sqrt(c))",
          .acts_on = ActsOn::structure,
          .axes = {""},
          .parameters = {{"compliance_s2", "s2", 0, 0, 0.3, "c; stiffer than 12 Hz counts as rigid"},
                         {"damping_ratio", "1", 0.02, 0, 1, "z"}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<JibFlexibility>(s);
          }};
}

}  // namespace crane::plant
