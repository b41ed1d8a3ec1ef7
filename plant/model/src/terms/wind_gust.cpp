#include <cmath>
#include <random>

#include "crane/plant/term.hpp"
#include "terms/load_force.hpp"

namespace crane::plant {
namespace {

/// Gusts of the Dryden model. Its longitudinal spectrum is that of a first-order process with the correlation
/// time L / V,
///   S(omega) = (2 sigma^2 L / (pi V)) / (1 + (omega L / V)^2)
/// which has the exact values at the ticks
///   u_k+1 = q u_k + sigma sqrt(1 - q^2) n_k,   q = exp(-V T / L),   n_k normal with variance 1
/// The gust is constant between two ticks, and 0 at the start.
class WindGust final : public Term {
 public:
  explicit WindGust(const TermSetting& s)
      : coefficient_ns2pm2_(s.parameters.at("coefficient_ns2pm2")),
        mean_mps_(s.parameters.at("mean_mps")),
        scatter_mps_(s.parameters.at("scatter_mps")),
        length_m_(s.parameters.at("length_m")),
        direction_rad_(s.parameters.at("direction_rad")),
        random_(static_cast<std::uint64_t>(s.parameters.at("seed"))) {}

  void begin_tick(double period_s) noexcept override {
    const double kept = std::exp(-mean_mps_ * period_s / length_m_);
    gust_mps_ = kept * gust_mps_ + scatter_mps_ * std::sqrt(1 - kept * kept) * normal_(random_);
  }

  void add_force(const Parameters& crane, const State& state, const motion::Angles<double>& cable,
                 Forces& sum) const noexcept override {
    const double angle_rad = direction_rad_ - state.slew_rad;  // relative to the jib
    const Eigen::Vector3d relative_mps =
        (mean_mps_ + gust_mps_) * Eigen::Vector3d{std::cos(angle_rad), std::sin(angle_rad), 0} -
        load_velocity_mps(crane, state, cable);
    add_load_force(crane, state, cable, coefficient_ns2pm2_ * relative_mps.norm() * relative_mps, sum);
  }

 private:
  double coefficient_ns2pm2_, mean_mps_, scatter_mps_, length_m_, direction_rad_;
  double gust_mps_ = 0;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace

TermKind wind_gust() {
  return {
      .name = "wind_gust",
      .equation =
          "F = d |w| w, w = (V + u) {cos(a - gamma), sin(a - gamma), 0} - r_L'; u_k+1 = q u_k + sigma sqrt(1 "
          "- q^2) n_k, q = exp(-V T / L), T the period, n_k normal with variance 1",
      .effect =
          "the drag of moving air acts on the load; u is the longitudinal gust of the Dryden model "
          "(MIL-F-8785C, section 3.7.2)",
      .acts_on = ActsOn::load,
      .axes = {""},
      .parameters = {{"coefficient_ns2pm2", "N s2/m2", 0, 0, 1000, "d = rho c_w A / 2"},
                     {"mean_mps", "m/s", 0, 0, 60, "V, mean speed of the wind; 0: no gusts"},
                     {"scatter_mps", "m/s", 0, 0, 20, "sigma, standard deviation of the gust u"},
                     {"length_m", "m", 23, 0.1, 1000,
                      "L, length scale of the gusts; 23 m at a height of 3 m (MIL-F-8785C)"},
                     {"direction_rad", "rad", 0, -7, 7,
                      "a, direction of the wind; 0: along the jib at gamma = 0"},
                     {"seed", "1", 1, 0, 1e6, "whole number; the same seed gives the same gusts"}},
      .example = {"wind_gust", "", {{"coefficient_ns2pm2", 0.015}, {"mean_mps", 5}, {"scatter_mps", 1.5}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<WindGust>(s); }};
}

}  // namespace crane::plant
