#include "crane/plant/term.hpp"
#include "terms/load_force.hpp"

namespace crane::plant {
namespace {

class LoadQuadraticDrag final : public Term {
 public:
  explicit LoadQuadraticDrag(const TermSetting& s)
      : coefficient_ns2pm2_(s.parameters.at("coefficient_ns2pm2")) {}

  void add_force(const Parameters& crane, const State& state, const motion::Angles<double>& cable,
                 Forces& sum) const noexcept override {
    const Eigen::Vector3d velocity_mps = load_velocity_mps(crane, state, cable);
    add_load_force(crane, state, cable, -coefficient_ns2pm2_ * velocity_mps.norm() * velocity_mps, sum);
  }

 private:
  double coefficient_ns2pm2_;
};

}  // namespace

TermKind load_quadratic_drag() {
  return {.name = "load_quadratic_drag",
          .equation = "F = -d |r_L'| r_L'",
          .effect = "the drag of still air acts on the load, d = rho c_w A / 2",
          .acts_on = ActsOn::load,
          .axes = {""},
          .parameters = {{"coefficient_ns2pm2", "N s2/m2", 0, 0, 1e6, "d, force / speed^2"}},
          .example = {"load_quadratic_drag", "", {{"coefficient_ns2pm2", 0.1}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<LoadQuadraticDrag>(s);
          }};
}

}  // namespace crane::plant
