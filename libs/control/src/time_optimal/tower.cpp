#include "tower.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "crane/plant/motion_terms.hpp"

namespace crane::control::time_optimal {
namespace {

namespace motion = plant::motion;

/// A number with its derivatives with respect to x, phi, theta, x', phi', gamma', theta'.
struct Dual {
  static constexpr int kInputs = 7;
  using Slope = Eigen::Matrix<double, kInputs, 1>;
  double value = 0;
  Slope slope = Slope::Zero();

  Dual() = default;
  Dual(double constant)
      : value{constant} {}  // NOLINT(google-explicit-constructor): a constant is a Dual with slope 0
  Dual(double v, Slope s) : value{v}, slope{std::move(s)} {}
  static Dual input(double v, int index) { return {v, Slope::Unit(index)}; }
};
Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.slope + b.slope}; }
Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.slope - b.slope}; }
Dual operator*(const Dual& a, const Dual& b) {
  return {a.value * b.value, a.slope * b.value + b.slope * a.value};
}
// These overloads avoid a Dual with slope 0 for each constant.
Dual operator+(double a, const Dual& b) { return {a + b.value, b.slope}; }
Dual operator-(double a, const Dual& b) { return {a - b.value, -b.slope}; }
Dual operator*(double a, const Dual& b) { return {a * b.value, b.slope * a}; }
Dual sin(const Dual& a) { return {std::sin(a.value), a.slope * std::cos(a.value)}; }
Dual cos(const Dual& a) { return {std::cos(a.value), a.slope * -std::sin(a.value)}; }

/// M(q) and h at constant length; `input(i)` is the number of state i.
template <class Number>
struct Equations {
  motion::Mass<Number> m;
  std::array<Number, 4> h;

  template <class Input>
  Equations(const Tower& tower, const Input& input) {
    const plant::Parameters& p = tower.design.crane;
    const motion::Motion<Number> at{.angles = {input(1), input(3)},
                                    .trolley_m = input(0),
                                    .trolley_mps = input(4),
                                    .radial_radps = input(5),
                                    .slew_radps = input(6),
                                    .tangential_radps = input(7),
                                    .cable_m = tower.cable_m};
    constexpr auto kFixed = motion::Cable::fixed;
    m = motion::mass(p, at.angles, at.trolley_m, at.cable_m);
    h = {motion::trolley_bias<kFixed>(p, at), motion::radial_bias<kFixed>(p, at),
         motion::slew_bias<kFixed>(p, at), motion::tangential_bias<kFixed>(p, at)};
  }
};

Eigen::Matrix4d matrix_of(const motion::Mass<double>& e) {
  Eigen::Matrix4d m;
  m << e.m11, e.m12, e.m13, e.m14,  //
      e.m12, e.m22, e.m23, 0,       //
      e.m13, e.m23, e.m33, e.m34,   //
      e.m14, 0, e.m34, e.m44;
  return m;
}

/// State number of each input of Dual. The slew angle is not an input, because the equations do not
/// depend on it.
constexpr std::array<int, Dual::kInputs> kStateOfInput{0, 1, 3, 4, 5, 6, 7};

/// Derivatives of M(q) a + h with respect to the inputs of Dual, at constant a.
Eigen::Matrix<double, 4, Dual::kInputs> residual_slope(const Tower& tower, const State& s,
                                                       const Eigen::Vector4d& a) {
  const Equations<Dual> e(tower, [&](int state) {
    const auto input = std::find(kStateOfInput.begin(), kStateOfInput.end(), state) - kStateOfInput.begin();
    return Dual::input(s[state], static_cast<int>(input));
  });
  const auto& m = e.m;
  Eigen::Matrix<double, 4, Dual::kInputs> slope;
  slope.row(0) = (m.m12.slope * a[1] + m.m13.slope * a[2] + m.m14.slope * a[3] + e.h[0].slope).transpose();
  slope.row(1) = (m.m12.slope * a[0] + m.m22.slope * a[1] + m.m23.slope * a[2] + e.h[1].slope).transpose();
  slope.row(2) =
      (m.m13.slope * a[0] + m.m23.slope * a[1] + m.m33.slope * a[2] + m.m34.slope * a[3] + e.h[2].slope)
          .transpose();
  slope.row(3) = (m.m14.slope * a[0] + m.m34.slope * a[2] + e.h[3].slope).transpose();
  return slope;
}

}  // namespace

Friction smooth_friction(const DriveFriction& f, double speed) noexcept {
  constexpr double kSmooth = 0.05;  // m/s, rad/s; a Runge-Kutta step of 40 ms is stable from 0.03 on
  const double side = std::tanh(speed / kSmooth), slope = (1 - side * side) / kSmooth;
  const double mean = (f.coulomb_positive_v + f.coulomb_negative_v) / 2;
  const double difference = (f.coulomb_positive_v - f.coulomb_negative_v) / 2;
  const double b_mean = (f.viscous_positive_vspm + f.viscous_negative_vspm) / 2;
  const double b_difference = (f.viscous_positive_vspm - f.viscous_negative_vspm) / 2;
  // c+ for side = 1, -c- for side = -1, 0 at rest; b+ and b- in the same way
  return {f.factor * (mean * side + difference * side * side + (b_mean + b_difference * side) * speed),
          f.factor * (mean * slope + 2 * difference * side * slope + b_mean +
                      b_difference * (side + slope * speed))};
}

void flow(const Tower& tower, const State& s, const Control& volts, bool derivatives, Flow& result) noexcept {
  const plant::Parameters& p = tower.design.crane;
  const Friction trolley = smooth_friction(tower.design.friction[kTrolley], s[4]);
  const Friction slew = smooth_friction(tower.design.friction[kSlew], s[6]);
  const double trolley_npv = p.trolley_inertia_kg * p.trolley_gain_mps2pv;
  const double slew_nmpv = p.jib_inertia_kgm2 * p.slew_gain_radps2pv;
  const Equations<double> e(tower, [&](int state) { return s[state]; });
  const Eigen::Matrix4d inverse = matrix_of(e.m).inverse();
  const Eigen::Vector4d force{trolley_npv * (volts[0] - trolley.volts) - e.h[0], -e.h[1],
                              slew_nmpv * (volts[1] - slew.volts) - e.h[2], -e.h[3]};
  const Eigen::Vector4d a = inverse * force;
  result.rate << s.tail<4>(), a;
  if (!derivatives) return;
  Eigen::Matrix<double, 4, Dual::kInputs> slope = residual_slope(tower, s, a);
  slope(0, 3) += trolley_npv * trolley.slope;
  slope(2, 5) += slew_nmpv * slew.slope;
  slope = -(inverse * slope).eval();
  result.by_state.setZero();
  result.by_state.topRightCorner<4, 4>().setIdentity();
  for (int i = 0; i < Dual::kInputs; ++i)
    result.by_state.col(kStateOfInput[static_cast<std::size_t>(i)]).tail<4>() = slope.col(i);
  result.by_control.setZero();
  result.by_control.col(0).tail<4>() = inverse.col(0) * trolley_npv;
  result.by_control.col(1).tail<4>() = inverse.col(2) * slew_nmpv;
}

void step(const Tower& tower, const State& s, const Control& volts, double h, bool derivatives,
          Step& result) noexcept {
  constexpr std::array<double, 4> kShare{0, 0.5, 0.5, 1}, kWeight{1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  Flow at;
  State k = State::Zero(), k_by_h = State::Zero();
  StateMatrix k_by_s = StateMatrix::Zero();
  ControlMatrix k_by_u = ControlMatrix::Zero();
  result.next = s;
  result.by_state.setIdentity();
  result.by_control.setZero();
  result.by_duration.setZero();
  for (std::size_t i = 0; i < 4; ++i) {
    const double part = kShare[i] * h;
    flow(tower, s + part * k, volts, derivatives, at);
    if (derivatives) {
      k_by_h = (at.by_state * (kShare[i] * k + part * k_by_h)).eval();
      k_by_s = (at.by_state + part * (at.by_state * k_by_s)).eval();
      k_by_u = (at.by_control + part * (at.by_state * k_by_u)).eval();
      result.by_state += kWeight[i] * h * k_by_s;
      result.by_control += kWeight[i] * h * k_by_u;
      result.by_duration += kWeight[i] * (at.rate + h * k_by_h);
    }
    k = at.rate;
    result.next += kWeight[i] * h * k;
  }
}

}  // namespace crane::control::time_optimal
