#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class CableLength final : public Term {
 public:
  explicit CableLength(const TermSetting& s) : delta_m_(s.parameters.at("delta_m")) {}

  [[nodiscard]] Displacement rest_displacement(const Parameters& /*crane*/) const noexcept override {
    return {.cable_m = delta_m_};
  }

 private:
  double delta_m_;
};

}  // namespace

TermKind cable_length() {
  return {
      .name = "cable_length",
      .equation = "L = L_measured + d",
      .effect =
          "the distance from the suspension point to the centre of mass of the load differs from the "
          "measured "
          "cable length",
      .acts_on = ActsOn::structure,
      .axes = {""},
      .parameters = {{"delta_m", "m", 0, -10, 10, "d, true minus measured cable length"}},
      .example = {"cable_length", "", {{"delta_m", 0.05}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<CableLength>(s); }};
}

}  // namespace crane::plant
