#include "tower.hpp"

#include <Eigen/LU>
#include <cmath>

namespace crane::control::time_optimal {
namespace {

// Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes, with the errata of docs/equations.md.

/// A number with its derivatives by x, phi, theta, x', phi', gamma', theta'.
struct Dual {
  static constexpr int kInputs = 7;
  using Slope = Eigen::Matrix<double, kInputs, 1>;
  double value = 0;
  Slope slope = Slope::Zero();

  Dual() = default;
  Dual(double constant) : value{constant} {}  // NOLINT(google-explicit-constructor): a constant is a number
  Dual(double v, Slope s) : value{v}, slope{std::move(s)} {}
  static Dual input(double v, int index) { return {v, Slope::Unit(index)}; }
};
Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.slope + b.slope}; }
Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.slope - b.slope}; }
Dual operator*(const Dual& a, const Dual& b) {
  return {a.value * b.value, a.slope * b.value + b.slope * a.value};
}
Dual sin(const Dual& a) { return {std::sin(a.value), a.slope * std::cos(a.value)}; }
Dual cos(const Dual& a) { return {std::cos(a.value), a.slope * -std::sin(a.value)}; }

/// The equations (2.17) to (2.20) at constant length, M(q) q'' + h = F, for doubles and duals.
template <class Number>
struct Equations {
  Number m12, m13, m14, m22, m23, m33, m34;
  double m11, m44;
  Number h1, h2, h3, h4;

  Equations(const plant::Parameters& p, double l, const Number& x, const Number& f, const Number& t,
            const Number& dx, const Number& df, const Number& dg, const Number& dt) {
    using std::cos, std::sin;
    const double m = p.load_mass_kg, ml = m * l, ml2 = ml * l, g = p.gravity_mps2,
                 moved = p.trolley_mass_kg + m;
    const Number sf = sin(f), cf = cos(f), st = sin(t), ct = cos(t);
    const Number sfct = sf * ct, cfct = cf * ct;
    m11 = p.trolley_inertia_kg + m;
    m44 = ml2;
    m12 = -ml * cfct;
    m13 = -ml * st;
    m14 = ml * (sf * st);
    m22 = ml2 * (ct * ct);
    m23 = ml2 * (cfct * st);
    m33 = p.jib_inertia_kgm2 + moved * (x * x) - 2 * ml * (x * sfct) + ml2 * (1.0 - cfct * cfct);
    m34 = ml * (x * ct - l * sf);
    const Number reach = l * (cf * cf * ct) + x * sf;  // of the load's centrifugal force
    const Number dg2 = dg * dg, df2 = df * df, dt2 = dt * dt;
    h1 = ml * (sfct * (df2 + dg2 + dt2)) - moved * (x * dg2) + 2 * ml * (st * cf * df * dt) -
         2 * ml * (ct * dg * dt);
    h2 = ml * (ct * (g * sf + (x - l * sfct) * cf * dg2 + 2 * l * (cfct * dg * dt) - 2 * l * (st * df * dt)));
    h3 = 2.0 * (dg * dx * (moved * x - ml * sfct)) + 2 * ml * (dg * df * cfct * (l * sfct - x)) +
         2 * ml * (dg * dt * st * reach) - ml2 * (df2 * sfct * st) - 2 * ml2 * (df * dt * st * st * cf) -
         ml * (x * st * dt2);
    h4 = ml * (g * (cf * st) + 2.0 * (dx * dg * ct) + l * (df2 * st * ct) - 2 * l * (df * dg * cf * ct * ct) -
               dg2 * st * reach);
  }
};

Eigen::Matrix4d mass_matrix(const Equations<double>& e) {
  Eigen::Matrix4d m;
  m << e.m11, e.m12, e.m13, e.m14,  //
      e.m12, e.m22, e.m23, 0,       //
      e.m13, e.m23, e.m33, e.m34,   //
      e.m14, 0, e.m34, e.m44;
  return m;
}

/// Derivatives of M(q) a + h by the inputs of Dual, at constant a.
Eigen::Matrix<double, 4, Dual::kInputs> residual_slope(const Tower& tower, const State& s,
                                                       const Eigen::Vector4d& a) {
  const auto input = [&](int state, int index) { return Dual::input(s[state], index); };
  const Equations<Dual> e(tower.design.crane, tower.cable_m, input(0, 0), input(1, 1), input(3, 2),
                          input(4, 3), input(5, 4), input(6, 5), input(7, 6));
  Eigen::Matrix<double, 4, Dual::kInputs> slope;
  slope.row(0) = (e.m12.slope * a[1] + e.m13.slope * a[2] + e.m14.slope * a[3] + e.h1.slope).transpose();
  slope.row(1) = (e.m12.slope * a[0] + e.m22.slope * a[1] + e.m23.slope * a[2] + e.h2.slope).transpose();
  slope.row(2) =
      (e.m13.slope * a[0] + e.m23.slope * a[1] + e.m33.slope * a[2] + e.m34.slope * a[3] + e.h3.slope)
          .transpose();
  slope.row(3) = (e.m14.slope * a[0] + e.m34.slope * a[2] + e.h4.slope).transpose();
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
  const Equations<double> e(p, tower.cable_m, s[0], s[1], s[3], s[4], s[5], s[6], s[7]);
  const Eigen::Matrix4d inverse = mass_matrix(e).inverse();
  const Eigen::Vector4d force{trolley_npv * (volts[0] - trolley.volts) - e.h1, -e.h2,
                              slew_nmpv * (volts[1] - slew.volts) - e.h3, -e.h4};
  const Eigen::Vector4d a = inverse * force;
  result.rate << s.tail<4>(), a;
  if (!derivatives) return;
  Eigen::Matrix<double, 4, Dual::kInputs> slope = residual_slope(tower, s, a);
  slope(0, 3) += trolley_npv * trolley.slope;
  slope(2, 5) += slew_nmpv * slew.slope;
  slope = -(inverse * slope).eval();
  result.by_state.setZero();
  result.by_state.topRightCorner<4, 4>().setIdentity();
  constexpr std::array<int, Dual::kInputs> kColumn{0, 1, 3, 4, 5, 6, 7};
  for (int i = 0; i < Dual::kInputs; ++i)
    result.by_state.col(kColumn[static_cast<std::size_t>(i)]).tail<4>() = slope.col(i);
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
