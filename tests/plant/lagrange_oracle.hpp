#pragma once
/// Independent derivation of the equations of motion from positions relative to the ground: automatic
/// differentiation with nested dual numbers gives the velocity of the load, the momenta and Lagrange's
/// equations (2.16).
#include <array>
#include <cmath>
#include <random>

#include "crane/plant/matrices.hpp"

namespace crane::test {

/// value + slope * e with e^2 = 0; nests for higher derivatives.
template <class T>
struct Dual {
  T value{};
  T slope{};
  Dual() = default;
  Dual(double v) : value(v), slope(0.0) {}  // NOLINT: constants mix with variables
  Dual(T v, T s) : value(v), slope(s) {}
  friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.slope + b.slope}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.slope - b.slope}; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.value * b.slope + a.slope * b.value};
  }
  friend Dual sin(const Dual& a) { return {sin_of(a.value), cos_of(a.value) * a.slope}; }
  friend Dual cos(const Dual& a) { return {cos_of(a.value), T(0.0) - sin_of(a.value) * a.slope}; }

 private:
  static T sin_of(const T& v) {
    using std::sin;
    return sin(v);
  }
  static T cos_of(const T& v) {
    using std::cos;
    return cos(v);
  }
};

inline constexpr std::size_t kQ = 5;  // x, phi, gamma, theta, L
template <class T>
using Q = std::array<T, kQ>;

/// Position relative to the ground of the point (ahead, across, up) of the jib frame: rotated by the tilt
/// about the horizontal across the jib, then by the slew angle about the vertical.
template <class T>
std::array<T, 3> over_ground(const plant::Parameters& p, const T& gamma, const T& ahead, const T& across,
                             const T& up) {
  using std::cos;
  using std::sin;
  const T c(p.tilt_cosine), s(p.tilt_sine);
  const T level = c * ahead - s * up;
  return {level * cos(gamma) - across * sin(gamma), level * sin(gamma) + across * cos(gamma),
          s * ahead + c * up};
}

/// Position of the load relative to the ground, from (2.11).
template <class T>
std::array<T, 3> load_over_ground(const plant::Parameters& p, const Q<T>& q) {
  using std::cos;
  using std::sin;
  const auto& [x, phi, gamma, theta, l] = q;
  return over_ground(p, gamma, x - l * cos(theta) * sin(phi), l * sin(theta),
                     T(0.0) - l * cos(theta) * cos(phi));
}

template <class T>
std::array<T, 3> trolley_over_ground(const plant::Parameters& p, const Q<T>& q) {
  return over_ground(p, q[2], q[0], T(0.0), T(0.0));
}

/// T - V. The inertia of the leadscrew, M - M_j, moves with x' only.
template <class T>
T lagrangian(const plant::Parameters& p, const Q<T>& q, const Q<T>& rate) {
  Q<Dual<T>> moving;
  for (std::size_t i = 0; i < kQ; ++i) moving[i] = Dual<T>{q[i], rate[i]};
  const auto load = load_over_ground(p, moving);
  const auto trolley = trolley_over_ground(p, moving);
  T load2{0.0}, trolley2{0.0};
  for (const auto& c : load) load2 = load2 + c.slope * c.slope;
  for (const auto& c : trolley) trolley2 = trolley2 + c.slope * c.slope;
  return T(0.5 * p.load_mass_kg) * load2 + T(0.5 * p.trolley_mass_kg) * trolley2 +
         T(0.5 * (p.trolley_inertia_kg - p.trolley_mass_kg)) * rate[0] * rate[0] +
         T(0.5 * p.jib_inertia_kgm2) * rate[2] * rate[2] -
         T(p.load_mass_kg * p.gravity_mps2) * load[2].value -
         T(p.trolley_mass_kg * p.gravity_mps2) * trolley[2].value;
}

inline Q<double> coordinates(const plant::State& s) {
  return {s.trolley_m, s.radial_rad, s.slew_rad, s.tangential_rad, s.cable_m};
}
inline Q<double> rates(const plant::State& s) {
  return {s.trolley_mps, s.radial_radps, s.slew_radps, s.tangential_radps, s.cable_mps};
}
inline Q<double> values(const plant::Accelerations& a) {
  return {a.trolley_mps2, a.radial_radps2, a.slew_radps2, a.tangential_radps2, a.cable_mps2};
}

/// Generalised forces of Lagrange's equations (2.16), d/dt (dL/dq') - dL/dq, including the one on L.
inline Q<double> required_forces(const plant::Parameters& p, const plant::State& s,
                                 const plant::Accelerations& a) {
  using D = Dual<double>;
  using DD = Dual<D>;
  const Q<double> q = coordinates(s), v = rates(s), acceleration = values(a);
  Q<double> force{};
  for (std::size_t j = 0; j < kQ; ++j) {
    Q<DD> q_t, v_t;  // inner: time, outer: q'_j
    Q<D> q_j, v_j;
    for (std::size_t i = 0; i < kQ; ++i) {
      q_t[i] = DD{D{q[i], v[i]}, D{0.0}};
      v_t[i] = DD{D{v[i], acceleration[i]}, D{i == j ? 1.0 : 0.0}};
      q_j[i] = D{q[i], i == j ? 1.0 : 0.0};
      v_j[i] = D{v[i]};
    }
    force[j] = lagrangian(p, q_t, v_t).slope.slope - lagrangian(p, q_j, v_j).slope;
  }
  return force;
}

/// Momenta dL/dq'.
inline Q<double> momenta(const plant::Parameters& p, const plant::State& s) {
  using D = Dual<double>;
  Q<double> momentum{};
  for (std::size_t j = 0; j < kQ; ++j) {
    Q<D> q, v;
    for (std::size_t i = 0; i < kQ; ++i) {
      q[i] = D{coordinates(s)[i]};
      v[i] = D{rates(s)[i], i == j ? 1.0 : 0.0};
    }
    momentum[j] = lagrangian(p, q, v).slope;
  }
  return momentum;
}

inline constexpr unsigned kSeed = 20021;

/// Swings up to 70 degrees, and speeds far above those of the rig.
inline plant::State random_state(std::mt19937& random) {
  const auto in = [&random](double low, double high) {
    return std::uniform_real_distribution{low, high}(random);
  };
  return {.trolley_m = in(0.1, 1.5),
          .radial_rad = in(-1.2, 1.2),
          .slew_rad = in(-4, 4),
          .tangential_rad = in(-1.2, 1.2),
          .cable_m = in(0.3, 2),
          .trolley_mps = in(-2, 2),
          .radial_radps = in(-3, 3),
          .slew_radps = in(-2, 2),
          .tangential_radps = in(-3, 3),
          .cable_mps = in(-1, 1)};
}

inline plant::Parameters random_crane(std::mt19937& random) {
  const auto in = [&random](double low, double high) {
    return std::uniform_real_distribution{low, high}(random);
  };
  plant::Parameters p;
  p.trolley_mass_kg = in(0, 5);
  p.trolley_inertia_kg = p.trolley_mass_kg + in(0.1, 30);
  p.load_mass_kg = in(0.1, 10);
  p.jib_inertia_kgm2 = in(1, 20);
  return p;
}

/// The same; the jib of odd cases is inclined by up to 0.3 rad.
inline plant::Parameters random_inclined_crane(std::mt19937& random, unsigned number) {
  plant::Parameters p = random_crane(random);
  if (number % 2 == 0) return p;
  const double tilt_rad = std::uniform_real_distribution{-0.3, 0.3}(random);
  p.tilt_sine = std::sin(tilt_rad);
  p.tilt_cosine = std::cos(tilt_rad);
  return p;
}

inline plant::Forces random_forces(std::mt19937& random) {
  std::uniform_real_distribution<double> in{-20, 20};
  return {in(random), in(random), in(random), in(random)};
}

}  // namespace crane::test
