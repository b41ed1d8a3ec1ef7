#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class PayloadMass final : public Term {
 public:
  explicit PayloadMass(const TermSetting& s) : delta_kg_(s.parameters.at("delta_kg")) {}

  void change_parameters(Parameters& crane) const noexcept override { crane.load_mass_kg += delta_kg_; }

 private:
  double delta_kg_;
};

}  // namespace

TermKind payload_mass() {
  return {
      .name = "payload_mass",
      .equation = "m = m_rig_file + d",
      .effect = "the load mass differs from that of the rig file",
      .acts_on = ActsOn::parameters,
      .axes = {""},
      .parameters = {{"delta_kg", "kg", 0, -1e6, 1e6,
                      "d, true load mass minus that of the rig file; the true mass must not be negative"}},
      .example = {"payload_mass", "", {{"delta_kg", 0.5}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<PayloadMass>(s); }};
}

}  // namespace crane::plant
