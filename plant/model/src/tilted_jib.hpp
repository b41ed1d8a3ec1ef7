#pragma once
/// Crane whose jib is inclined by the angle a out of the horizontal; the slew axis remains vertical
/// (docs/equations.md#tilted-jib). In the slewing frame, whose third axis is vertical, the cable has the
/// angles phi - a and theta, and the trolley has the horizontal distance x cos(a). With these
/// values the equations of the horizontal jib hold, except that the trolley also moves vertically with x
/// sin(a).
#include "crane/plant/motion_terms.hpp"

namespace crane::plant::tilted {

/// Sines and cosines of phi - a and theta from those of phi and theta.
inline motion::Angles<double> level(const Parameters& p, const motion::Angles<double>& jib) noexcept {
  motion::Angles<double> angles = jib;
  angles.sf = jib.sf * p.tilt_cosine - jib.cf * p.tilt_sine;
  angles.cf = jib.cf * p.tilt_cosine + jib.sf * p.tilt_sine;
  return angles;
}

/// Motion in the slewing frame.
inline motion::Motion<double> level(const Parameters& p, motion::Motion<double> s) noexcept {
  s.angles = level(p, s.angles);
  s.trolley_m *= p.tilt_cosine;
  s.trolley_mps *= p.tilt_cosine;
  return s;
}

/// M(q). @param jib  sines and cosines of phi and theta
inline motion::Mass<double> mass(const Parameters& p, const motion::Angles<double>& jib, double trolley_m,
                                 double cable_m) noexcept {
  const double ml = p.load_mass_kg * cable_m;
  motion::Mass<double> m = motion::mass(p, level(p, jib), trolley_m * p.tilt_cosine, cable_m);
  m.m12 = -ml * jib.cf * jib.ct;  // the trolley moves along the jib
  m.m13 *= p.tilt_cosine;
  m.m14 = ml * jib.sf * jib.st;
  return m;
}

/// h1; h2, h3 and h4 are those of the horizontal jib. @param level  motion in the slewing frame
inline double trolley_bias(const Parameters& p, const motion::Motion<double>& level) noexcept {
  const auto& a = level.angles;
  const double m = p.load_mass_kg, l = level.cable_m;
  const double f = level.radial_radps, t = level.tangential_radps;
  // vertical acceleration of the load for phi'' = theta'' = x'' = 0
  const double lifting_mps2 = l * (a.cf * a.ct * (f * f + t * t) - 2 * a.sf * a.st * f * t) +
                              2 * level.cable_mps * (a.sf * a.ct * f + a.cf * a.st * t) -
                              level.cable_mps2 * a.cf * a.ct;
  const double weight_n = (p.centrifugal_share * p.trolley_mass_kg + m) * p.gravity_mps2;
  return p.tilt_cosine * motion::trolley_bias<motion::Cable::moving>(p, level) +
         p.tilt_sine * (m * lifting_mps2 + weight_n);
}

}  // namespace crane::plant::tilted
