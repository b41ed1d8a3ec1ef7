#include <cmath>

#include "crane/plant/term.hpp"
#include "terms/load_force.hpp"

namespace crane::plant {
namespace {

/// The inner coordinates are the angles of the lower cable relative to the upper cable. Their initial value 0
/// puts the load in line with the upper cable, for any initial swing.
class DoublePendulum final : public Term {
 public:
  explicit DoublePendulum(const TermSetting& s)
      : lower_share_(s.parameters.at("lower_share")),
        lower_length_m_(s.parameters.at("lower_length_m")),
        hook_raised_m_(s.parameters.at("hook_raised_m")) {}

  void change_parameters(Parameters& crane) const noexcept override {
    crane.load_mass_kg *= 1 - lower_share_;
  }
  [[nodiscard]] Displacement rest_displacement(const Parameters& /*crane*/) const noexcept override {
    return {.cable_m = lower_share_ > 0 ? -hook_raised_m_ : 0};
  }
  [[nodiscard]] std::size_t inner_coordinates() const noexcept override { return lower_share_ > 0 ? 2 : 0; }

  void add_inner_force(const Parameters& crane, const State& state, const Inner* inner,
                       Forces& sum) const noexcept override {
    if (lower_share_ == 0) return;
    const double phi = state.radial_rad + inner[0].position, theta = state.tangential_rad + inner[1].position;
    const double weight_n = ratio() * crane.load_mass_kg * crane.gravity_mps2;
    const Eigen::Vector3d down_cable{-std::cos(theta) * std::sin(phi), std::sin(theta),
                                     -std::cos(theta) * std::cos(phi)};
    add_load_force(state, weight_n * down_cable, sum);
  }

  void accelerate(const Parameters& crane, const State& state, const Accelerations& drives,
                  const Inner* inner, double* acceleration) const noexcept override {
    if (lower_share_ == 0) return;
    const double stiffness = crane.gravity_mps2 / lower_length_m_ * (1 + ratio());
    const double phi = state.radial_rad + inner[0].position, theta = state.tangential_rad + inner[1].position;
    const double phi_rate = state.radial_radps + inner[0].rate;
    const double theta_rate = state.tangential_radps + inner[1].rate;
    const double turn = state.slew_radps, turning = drives.slew_radps2;
    acceleration[0] = stiffness * (std::sin(state.radial_rad) - std::sin(phi)) - 2 * turn * theta_rate -
                      turning * theta + turn * turn * phi - drives.radial_radps2;
    acceleration[1] = stiffness * (std::sin(state.tangential_rad) - std::sin(theta)) + 2 * turn * phi_rate +
                      turning * phi + turn * turn * theta - drives.tangential_radps2;
  }

 private:
  /// Mass below the hook / mass of the hook.
  [[nodiscard]] double ratio() const { return lower_share_ / (1 - lower_share_); }
  double lower_share_, lower_length_m_, hook_raised_m_;
};

}  // namespace

TermKind double_pendulum() {
  return {.name = "double_pendulum",
          .equation =
              "hook (1 - mu) m at L - u, load mu m at l below: l phi_2'' = g (1 + r)(sin(phi) - sin(phi_2)) "
              "+ rotation of the frame, likewise theta; F = mu m g along the lower cable on the hook; "
              "r = mu / (1 - mu)",
          .source = "Newton's law of both masses with the cables' tensions at rest; exact for small angles",
          .acts_on = ActsOn::structure,
          .axes = {""},
          .parameters =
              {{"lower_share", "1", 0, 0, 0.9, "mu, share of the load mass that hangs below the hook"},
               {"lower_length_m", "m", 0.3, 0.02, 10, "l, from the hook to the load"},
               {"hook_raised_m", "m", 0, 0, 10,
                "u, height of the hook above the end of the measured length; l when that end is the load"}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
            return std::make_unique<DoublePendulum>(s);
          }};
}

}  // namespace crane::plant
