#include <cmath>

#include "crane/plant/term.hpp"
#include "terms/load_force.hpp"

namespace crane::plant {
namespace {

class SteadyWind final : public Term {
 public:
  explicit SteadyWind(const TermSetting& s)
      : force_n_(s.parameters.at("force_n")), direction_rad_(s.parameters.at("direction_rad")) {}

  void add_force(const Parameters& crane, const State& state, const motion::Angles<double>& cable,
                 Forces& sum) const noexcept override {
    const double angle_rad = direction_rad_ - state.slew_rad;  // relative to the jib
    add_load_force(crane, state, cable,
                   force_n_ * Eigen::Vector3d{std::cos(angle_rad), std::sin(angle_rad), 0}, sum);
  }

 private:
  double force_n_, direction_rad_;
};

}  // namespace

TermKind steady_wind() {
  return {
      .name = "steady_wind",
      .equation = "F = F_w {cos(a - gamma), sin(a - gamma), 0}",
      .effect =
          "a steady wind exerts a constant force on the load, in a fixed direction relative to the ground",
      .acts_on = ActsOn::load,
      .axes = {""},
      .parameters = {{"force_n", "N", 0, -1000, 1000, "F_w, force; negative: against the direction"},
                     {"direction_rad", "rad", 0, -7, 7,
                      "a, direction of the force; 0: along the jib at gamma = 0"}},
      .example = {"steady_wind", "", {{"force_n", 0.3}, {"direction_rad", 1}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<SteadyWind>(s); }};
}

}  // namespace crane::plant
