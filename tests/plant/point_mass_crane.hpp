#pragma once
/// Crane on a vertical slew axis whose jib is inclined, from Newton's law for the load as a point mass in the
/// ground frame, with the cable as a constraint. No angles of the load, no mass matrix, no code of the plant:
/// an independent reference for tests.
#include <Eigen/Dense>
#include <array>
#include <cmath>

namespace crane::test {

struct PointMassCrane {
  using Vector = Eigen::Vector3d;

  // crane; the defaults are those of the Virginia Tech rig
  double gravity_mps2 = 9.81, inertia_kg = 22.46, carriage_kg = 1.97, load_kg = 2, jib_kgm2 = 7.2;
  double trolley_mps2pv = 2, slew_radps2pv = 1.14;
  std::array<double, 2> coulomb_v{}, viscous_vs{};  ///< friction of trolley and slew, V, V per m/s or rad/s
  double tilt_rad = 0;                              ///< > 0: the tip is raised
  bool slews = true;
  // state
  double x = 0, x_rate = 0, gamma = 0, gamma_rate = 0;
  Vector r = Vector::Zero(), v = Vector::Zero();  ///< of the load

  [[nodiscard]] Vector along() const {
    return {std::cos(tilt_rad) * std::cos(gamma), std::cos(tilt_rad) * std::sin(gamma), std::sin(tilt_rad)};
  }
  [[nodiscard]] Vector suspension() const { return x * along(); }
  /// The load at rest below the suspension point.
  void hang(double cable_m) {
    r = suspension() - cable_m * Vector::UnitZ();
    v = Vector::Zero();
  }

  /// One classical Runge-Kutta step of h at constant volts of trolley and slew.
  void step(const std::array<double, 2>& volts, double h) {
    const Slope a = slope(volts), b = moved(a, h / 2).slope(volts), c = moved(b, h / 2).slope(volts),
                d = moved(c, h).slope(volts);
    *this = moved(a, h / 6).moved(b, h / 3).moved(c, h / 3).moved(d, h / 6);
  }

  /// Swing along and across the jib, relative to the normal of the jib.
  [[nodiscard]] std::array<double, 2> swing_rad() const {
    const Vector ahead = along(), across{-std::sin(gamma), std::cos(gamma), 0}, normal = ahead.cross(across);
    const Vector n = (r - suspension()).normalized();
    return {std::atan2(-n.dot(ahead), -n.dot(normal)), std::asin(n.dot(across))};
  }

 private:
  struct Slope {
    double x = 0, x_rate = 0, gamma = 0, gamma_rate = 0;
    Vector r, v;
  };
  [[nodiscard]] double driving_v(std::size_t axis, double volts, double speed) const {
    return volts - coulomb_v[axis] * std::tanh(speed / 1e-3) - viscous_vs[axis] * speed;
  }
  /// The tension T accelerates load, trolley and jib; T follows from the second derivative of |r - p|^2 =
  /// L^2, in which x'' and gamma'' are linear in T.
  [[nodiscard]] Slope slope(const std::array<double, 2>& volts) const {
    const Vector up = Vector::UnitZ(), e = along(), p = suspension(), turn = gamma_rate * up;
    const Vector cable = r - p, n = cable / cable.norm(), slip = v - x_rate * e - turn.cross(p);
    const double level = std::pow(std::cos(tilt_rad), 2), inertia = jib_kgm2 + carriage_kg * level * x * x;
    // without tension
    const double x_free =
        trolley_mps2pv * driving_v(0, volts[0], x_rate) +
        carriage_kg / inertia_kg * (level * x * gamma_rate * gamma_rate - gravity_mps2 * std::sin(tilt_rad));
    const double gamma_free = (jib_kgm2 * slew_radps2pv * driving_v(1, volts[1], gamma_rate) -
                               2 * carriage_kg * level * x * x_rate * gamma_rate) /
                              inertia;
    // the cable pulls the trolley along the jib, and turns the jib by its torque about the vertical
    const double x_per_n = n.dot(e) / inertia_kg, gamma_per_n = up.dot(p.cross(n)) / inertia;
    const auto of_suspension = [&](double xx, double gg) -> Vector {
      return xx * e + (slews ? gg : 0) * up.cross(p);
    };
    const Vector bias = 2 * x_rate * turn.cross(e) + turn.cross(turn.cross(p));
    const Vector free = -gravity_mps2 * up - bias - of_suspension(x_free, gamma_free);
    const Vector per_n = -n / load_kg - of_suspension(x_per_n, gamma_per_n);
    const double tension_n = -(slip.squaredNorm() + cable.dot(free)) / cable.dot(per_n);
    return {.x = x_rate,
            .x_rate = x_free + tension_n * x_per_n,
            .gamma = gamma_rate,
            .gamma_rate = slews ? gamma_free + tension_n * gamma_per_n : 0,
            .r = v,
            .v = -gravity_mps2 * up - tension_n / load_kg * n};
  }
  [[nodiscard]] PointMassCrane moved(const Slope& d, double h) const {
    PointMassCrane next = *this;
    next.x += h * d.x, next.x_rate += h * d.x_rate;
    next.gamma += h * d.gamma, next.gamma_rate += h * d.gamma_rate;
    next.r += h * d.r, next.v += h * d.v;
    return next;
  }
};

}  // namespace crane::test
