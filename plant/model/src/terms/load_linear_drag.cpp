#include "crane/plant/term.hpp"
#include "terms/load_force.hpp"

namespace crane::plant {
namespace {

class LoadLinearDrag final : public Term {
 public:
  explicit LoadLinearDrag(const TermSetting& s) : coefficient_nspm_(s.parameters.at("coefficient_nspm")) {}

  void add_force(const Parameters& crane, const State& state, const motion::Angles<double>& cable,
                 Forces& sum) const noexcept override {
    add_load_force(crane, state, cable, -coefficient_nspm_ * load_velocity_mps(crane, state, cable), sum);
  }

 private:
  double coefficient_nspm_;
};

}  // namespace

TermKind load_linear_drag() {
  return {.name = "load_linear_drag",
          .equation = "F = -d r_L'",
          .effect =
              "viscous drag acts on the load; r_L' is the velocity of the load relative to the ground (2.12)",
          .acts_on = ActsOn::load,
          .axes = {""},
          .parameters = {{"coefficient_nspm", "N s/m", 0, 0, 1e6, "d, force / speed"}},
          .example = {"load_linear_drag", "", {{"coefficient_nspm", 0.1}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<LoadLinearDrag>(s);
          }};
}

}  // namespace crane::plant
