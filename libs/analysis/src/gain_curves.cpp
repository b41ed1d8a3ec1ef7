#include "crane/analysis/gain_curves.hpp"

namespace crane::analysis {
namespace {

double spread(double low, double high, int index, int points) {
  return low + (high - low) * index / (points - 1);
}

GainSample sample(double abscissa, const control::SwingAxis& axis) {
  const auto gains = control::partial_state_gains(axis);
  return {abscissa, gains, closed_loop_poles(axis, gains)};
}

}  // namespace

std::vector<Complex> closed_loop_poles(const control::SwingAxis& axis, const control::Gains& gains) {
  const double loop = gains.position * axis.drive_gain, g = axis.gravity_mps2;
  const Polynomial pendulum{g, 0, axis.cable_length_m};
  const Polynomial drive{loop, loop * gains.speed, 1};
  const Polynomial swing{0, 0, loop * gains.swing + axis.load_ratio * g, loop * gains.swing_rate};
  return roots_of(sum(product(pendulum, drive), swing));
}

GainCurve gains_over_cable_length(const plant::Parameters& crane, int points) {
  GainCurve curve;
  for (int i = 0; i < points; ++i) {
    const double length_m = spread(0.5, 5, i, points);
    curve.push_back(sample(length_m, control::trolley_axis(crane, length_m)));
  }
  return curve;
}

GainCurve gains_over_mass_ratio(const plant::Parameters& crane, double cable_length_m, int points) {
  GainCurve curve;
  for (int i = 0; i < points; ++i) {
    auto axis = control::trolley_axis(crane, cable_length_m);
    axis.load_ratio = spread(0, 3, i, points);
    curve.push_back(sample(axis.load_ratio, axis));
  }
  return curve;
}

GainCurve gains_over_trolley_position(const plant::Parameters& crane, double cable_length_m, int points) {
  GainCurve curve;
  for (int i = 0; i < points; ++i) {
    const double x_m = spread(0.1, 1.5, i, points);
    curve.push_back(sample(x_m, control::slew_axis(crane, cable_length_m, x_m)));
    curve.back().gains.swing /= x_m;
    curve.back().gains.swing_rate /= x_m;
  }
  return curve;
}

plant::Parameters figure_parameters(double load_to_jib_ratio) {
  plant::Parameters crane;
  crane.trolley_gain_mps2pv = crane.slew_gain_radps2pv = 1.34;
  crane.trolley_mass_kg = 0.5 * crane.jib_inertia_kgm2;
  crane.load_mass_kg = load_to_jib_ratio * crane.jib_inertia_kgm2;
  return crane;
}

}  // namespace crane::analysis
