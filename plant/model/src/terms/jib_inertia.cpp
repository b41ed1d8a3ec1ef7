#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class JibInertia final : public Term {
 public:
  explicit JibInertia(const TermSetting& s) : factor_(s.parameters.at("factor")) {}

  void change_parameters(Parameters& crane) const noexcept override { crane.jib_inertia_kgm2 *= factor_; }

 private:
  double factor_;
};

}  // namespace

TermKind jib_inertia() {
  return {
      .name = "jib_inertia",
      .equation = "J = k J_rig_file; the slew gain of the rig file, in rad/s2 per V, stays",
      .effect = "the inertia of the jib differs from that of the rig file",
      .acts_on = ActsOn::parameters,
      .axes = {""},
      .parameters = {{"factor", "1", 1, 0.1, 10, "k, true inertia of the jib over that of the rig file"}},
      .example = {"jib_inertia", "", {{"factor", 1.02}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<JibInertia>(s); }};
}

}  // namespace crane::plant
