#pragma once
/// Elements of M(q) and h of the equations of motion (2.17)-(2.20) (equations.hpp) for any number type:
/// double for the plant, a number with derivatives for planners. `Number` has +, -, * with itself and with
/// double. Source of the equation numbers: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech,
/// 2003, with the misprints corrected (docs/equations.md).
#include <cmath>

#include "crane/plant/parameters.hpp"

namespace crane::plant::motion {

/// Sines and cosines that the equations use more than once.
template <class Number>
struct Angles {
  Angles(const Number& radial_rad, const Number& tangential_rad) {
    using std::cos, std::sin;
    sf = sin(radial_rad), cf = cos(radial_rad);
    st = sin(tangential_rad), ct = cos(tangential_rad);
  }
  Number sf, cf, st, ct;  // sin and cos of phi, of theta
};

/// Arguments of h.
template <class Number>
struct Motion {
  Angles<Number> angles;
  Number trolley_m, trolley_mps, radial_radps, slew_radps, tangential_radps;
  double cable_m;
  double cable_mps = 0, cable_mps2 = 0;  ///< not used with Cable::fixed
};

/// Whether h contains the terms of L' and L''.
enum class Cable { fixed, moving };

/// Elements of M(q) in kg, kg m and kg m2. M24 = 0.
template <class Number>
struct Mass {
  double m11;
  Number m12, m13, m14, m22, m23, m33, m34;
  double m44;
};

/// @param x  trolley position, m
/// @param l  cable length L, m
template <class Number>
Mass<Number> mass(const Parameters& p, const Angles<Number>& a, const Number& x, double l) {
  const double m = p.load_mass_kg, ml = m * l, ml2 = ml * l;
  // squared horizontal component of the cable's unit vector
  const Number horizontal = 1.0 - a.cf * a.cf * a.ct * a.ct;
  return {.m11 = p.trolley_inertia_kg + m,
          .m12 = -ml * a.cf * a.ct,
          .m13 = -ml * a.st,
          .m14 = ml * a.sf * a.st,
          .m22 = ml2 * a.ct * a.ct,
          .m23 = ml2 * a.cf * a.st * a.ct,
          .m33 = p.jib_inertia_kgm2 + p.rotating_share * p.trolley_mass_kg * x * x +
                 m * (x * x - 2 * l * x * a.sf * a.ct + l * l * horizontal),
          .m34 = ml * (x * a.ct - l * a.sf),
          .m44 = ml2};
}

/// h1 of (2.17), N
template <Cable kCable, class Number>
Number trolley_bias(const Parameters& p, const Motion<Number>& s) {
  const auto& a = s.angles;
  const double m = p.load_mass_kg, ml = m * s.cable_m;
  const Number &f = s.radial_radps, &g = s.slew_radps, &t = s.tangential_radps;
  const Number at_constant_length = ml * a.sf * a.ct * (f * f + g * g + t * t) -
                                    (p.centrifugal_share * p.trolley_mass_kg + m) * s.trolley_m * g * g +
                                    2 * ml * a.st * a.cf * f * t - 2 * ml * a.ct * g * t;
  if constexpr (kCable == Cable::fixed) return at_constant_length;
  return at_constant_length - 2 * m * s.cable_mps * (a.cf * a.ct * f + a.st * g - a.sf * a.st * t) -
         m * a.sf * a.ct * s.cable_mps2;
}

/// h2 of (2.18), multiplied by m L cos(theta), N m
template <Cable kCable, class Number>
Number radial_bias(const Parameters& p, const Motion<Number>& s) {
  const auto& a = s.angles;
  const double l = s.cable_m;
  const Number &f = s.radial_radps, &g = s.slew_radps, &t = s.tangential_radps;
  Number acceleration_mps2 = p.gravity_mps2 * a.sf + (s.trolley_m - l * a.sf * a.ct) * a.cf * g * g +
                             2 * l * a.cf * a.ct * g * t - 2 * l * a.st * f * t;
  if constexpr (kCable == Cable::moving)
    acceleration_mps2 = acceleration_mps2 + 2 * s.cable_mps * (a.ct * f + a.cf * a.st * g);
  return p.load_mass_kg * l * a.ct * acceleration_mps2;
}

/// h3 of (2.19), N m
template <Cable kCable, class Number>
Number slew_bias(const Parameters& p, const Motion<Number>& s) {
  const auto& a = s.angles;
  const double m = p.load_mass_kg, l = s.cable_m, ml = m * l, ml2 = ml * l;
  const Number &x = s.trolley_m, &f = s.radial_radps, &g = s.slew_radps, &t = s.tangential_radps;
  const Number coriolis =
      2 * g * s.trolley_mps * ((p.rotating_share * p.trolley_mass_kg + m) * x - ml * a.sf * a.ct) +
      2 * ml * g * f * a.cf * a.ct * (l * a.sf * a.ct - x) +
      2 * ml * g * t * a.st * (l * a.cf * a.cf * a.ct + x * a.sf);
  const Number swinging =
      -ml2 * f * f * a.sf * a.st * a.ct - 2 * ml2 * f * t * a.st * a.st * a.cf - ml * x * a.st * t * t;
  if constexpr (kCable == Cable::fixed) return coriolis + swinging;
  const Number horizontal = 1.0 - a.cf * a.cf * a.ct * a.ct;
  const Number hoisting =
      2 * m * s.cable_mps *
          (g * (l * horizontal - x * a.sf * a.ct) + t * (x * a.ct - l * a.sf) + l * f * a.cf * a.st * a.ct) +
      m * x * a.st * s.cable_mps2;
  return coriolis + hoisting + swinging;
}

/// h4 of (2.20), multiplied by m L, N m
template <Cable kCable, class Number>
Number tangential_bias(const Parameters& p, const Motion<Number>& s) {
  const auto& a = s.angles;
  const double l = s.cable_m;
  const Number &f = s.radial_radps, &g = s.slew_radps, &t = s.tangential_radps;
  Number acceleration_mps2 = p.gravity_mps2 * a.cf * a.st + 2 * s.trolley_mps * g * a.ct +
                             l * f * f * a.st * a.ct - 2 * l * f * g * a.cf * a.ct * a.ct -
                             g * g * a.st * (l * a.cf * a.cf * a.ct + s.trolley_m * a.sf);
  if constexpr (kCable == Cable::moving)
    acceleration_mps2 = acceleration_mps2 + 2 * s.cable_mps * (t - a.sf * g);
  return p.load_mass_kg * l * acceleration_mps2;
}

}  // namespace crane::plant::motion
