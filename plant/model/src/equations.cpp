#include "crane/plant/equations.hpp"

#include <cmath>

#include "crane/plant/matrices.hpp"
#include "crane/plant/motion_terms.hpp"
#include "tilted_jib.hpp"

namespace crane::plant {
namespace {

// Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes (equations.hpp).

/// A vector with the components (x, phi, gamma, theta).
struct Column {
  double x, phi, gamma, theta;
};

using Mass = motion::Mass<double>;
using Angles = motion::Angles<double>;

bool tilts(const Parameters& p) { return p.tilt_sine != 0; }

Mass mass(const Parameters& p, const State& s, const Angles& angles) {
  return tilts(p) ? tilted::mass(p, angles, s.trolley_m, s.cable_m)
                  : motion::mass(p, angles, s.trolley_m, s.cable_m);
}
/// Angles in the slewing frame.
Angles level_angles(const Parameters& p, const State& s) {
  return tilted::level(p, Angles{s.radial_rad, s.tangential_rad});
}

motion::Motion<double> motion_of(const State& s, const Angles& angles, double cable_mps2) {
  return {.angles = angles,
          .trolley_m = s.trolley_m,
          .trolley_mps = s.trolley_mps,
          .radial_radps = s.radial_radps,
          .slew_radps = s.slew_radps,
          .tangential_radps = s.tangential_radps,
          .cable_m = s.cable_m,
          .cable_mps = s.cable_mps,
          .cable_mps2 = cable_mps2};
}

/// Solves M q = r for the free coordinates: eliminates the two swing equations, which are not coupled (M24 =
/// 0), and solves the remaining 2x2 system.
Column solve(const Mass& m, const Column& r, const Locks& locks) {
  const bool radial = !locks.radial && m.m22 > 0;
  const bool tangential = !locks.tangential && m.m44 > 0;
  double s11 = m.m11, s13 = m.m13, s33 = m.m33, rx = r.x, rg = r.gamma;
  if (radial) {
    const double a = m.m12 / m.m22, b = m.m23 / m.m22;
    s11 -= a * m.m12, s13 -= a * m.m23, s33 -= b * m.m23;
    rx -= a * r.phi, rg -= b * r.phi;
  }
  if (tangential) {
    const double a = m.m14 / m.m44, b = m.m34 / m.m44;
    s11 -= a * m.m14, s13 -= a * m.m34, s33 -= b * m.m34;
    rx -= a * r.theta, rg -= b * r.theta;
  }
  Column q{.x = locks.acceleration[kTrolley], .phi = 0, .gamma = locks.acceleration[kSlew], .theta = 0};
  if (!locks.axis[kTrolley] && !locks.axis[kSlew]) {
    const double inverse = 1 / (s11 * s33 - s13 * s13);
    q.x = (s33 * rx - s13 * rg) * inverse;
    q.gamma = (s11 * rg - s13 * rx) * inverse;
  } else if (!locks.axis[kTrolley]) {
    q.x = (rx - s13 * q.gamma) / s11;
  } else if (!locks.axis[kSlew]) {
    q.gamma = (rg - s13 * q.x) / s33;
  }
  if (radial) q.phi = (r.phi - m.m12 * q.x - m.m23 * q.gamma) / m.m22;
  if (tangential) q.theta = (r.theta - m.m14 * q.x - m.m34 * q.gamma) / m.m44;
  return q;
}

}  // namespace

Angles swing_angles(const Parameters& p, const State& s) noexcept {
  return p.load_mass_kg > 0 ? Angles{s.radial_rad, s.tangential_rad} : Angles{0, 0};
}

Accelerations accelerations(const Parameters& p, const State& s, const Forces& forces, double cable_mps2,
                            const Locks& locks) noexcept {
  return solution(motion_equations(p, s, swing_angles(p, s), forces, cable_mps2, locks), locks);
}

MotionEquations motion_equations(const Parameters& p, const State& s, const Angles& angles,
                                 const Forces& forces, double cable_mps2, const Locks& locks) noexcept {
  const double hoisting = locks.axis[kHoist] ? locks.acceleration[kHoist] : cable_mps2;
  motion::Motion<double> at = motion_of(s, angles, hoisting);
  if (tilts(p)) at = tilted::level(p, at);
  constexpr auto kMoving = motion::Cable::moving;
  MotionEquations equations{.mass = mass(p, s, angles), .net = {}, .cable_mps2 = hoisting};
  Forces& net = equations.net;
  if (!locks.axis[kTrolley])
    net.trolley_n =
        forces.trolley_n - (tilts(p) ? tilted::trolley_bias(p, at) : motion::trolley_bias<kMoving>(p, at));
  if (!locks.radial) net.radial_nm = forces.radial_nm - motion::radial_bias<kMoving>(p, at);
  if (!locks.axis[kSlew]) net.slew_nm = forces.slew_nm - motion::slew_bias<kMoving>(p, at);
  if (!locks.tangential) net.tangential_nm = forces.tangential_nm - motion::tangential_bias<kMoving>(p, at);
  return equations;
}

Accelerations solution(const MotionEquations& equations, const Locks& locks) noexcept {
  const Forces& net = equations.net;
  const Column q = solve(
      equations.mass,
      {.x = net.trolley_n, .phi = net.radial_nm, .gamma = net.slew_nm, .theta = net.tangential_nm}, locks);
  return {.trolley_mps2 = q.x,
          .radial_radps2 = q.phi,
          .slew_radps2 = q.gamma,
          .tangential_radps2 = q.theta,
          .cable_mps2 = equations.cable_mps2};
}

SwingResponse swing_response(const Mass& m, double trolley_mps2, double slew_radps2,
                             const Locks& locks) noexcept {
  SwingResponse response;
  if (!locks.radial && m.m22 > 0)
    response.radial_radps2 = -(m.m12 * trolley_mps2 + m.m23 * slew_radps2) / m.m22;
  if (!locks.tangential && m.m44 > 0)
    response.tangential_radps2 = -(m.m14 * trolley_mps2 + m.m34 * slew_radps2) / m.m44;
  return response;
}

DriveResponse drive_response(const Parameters& p, const State& s, const Locks& locks) noexcept {
  const Mass m = mass(p, s, swing_angles(p, s));
  Locks held = locks;
  held.acceleration = {};
  const Column by_force = solve(m, {.x = 1, .phi = 0, .gamma = 0, .theta = 0}, held),
               by_torque = solve(m, {.x = 0, .phi = 0, .gamma = 1, .theta = 0}, held);
  return {.trolley_mps2_pn = by_force.x, .slew_radps2_pnm = by_torque.gamma, .coupling = by_force.gamma};
}

CableTension cable_tension(const Parameters& p, const State& s) noexcept {
  return cable_tension(p, s, level_angles(p, s));
}

CableTension cable_tension(const Parameters& p, const State& s, const Angles& a) noexcept {
  const double l = s.cable_m, phi_rate = s.radial_radps, gamma_rate = s.slew_radps,
               theta_rate = s.tangential_radps;
  const double x = p.tilt_cosine * s.trolley_m, x_rate = p.tilt_cosine * s.trolley_mps;
  // horizontal components of the cable's unit vector in the slewing frame, and their rates
  const double ex = -a.ct * a.sf, ey = a.st;
  const double ex_rate = a.st * a.sf * theta_rate - a.ct * a.cf * phi_rate, ey_rate = a.ct * theta_rate;
  // component of the unit vector; phi is the sum of its value in the slewing frame and the tilt
  const double along_jib = -a.ct * (a.sf * p.tilt_cosine + a.cf * p.tilt_sine);
  const double centripetal = l * (phi_rate * phi_rate * a.ct * a.ct + theta_rate * theta_rate) +
                             gamma_rate * gamma_rate * (x * ex + l * (ex * ex + ey * ey));
  const double coriolis = 2 * gamma_rate * (x_rate * ey + l * (ex_rate * ey - ey_rate * ex));
  const double m = p.load_mass_kg;
  return {.free_n = m * (p.gravity_mps2 * a.ct * a.cf + centripetal - coriolis),
          .by_trolley_kg = -m * along_jib,
          .by_slew_kgm = -m * x * ey,
          .by_cable_kg = -m};
}

State stop_dead(const Parameters& p, const State& s, Axis axis, const Locks& locks) noexcept {
  const Angles a{s.radial_rad, s.tangential_rad};
  const Mass m = mass(p, s, a);
  const double lost = speed(s, axis);
  Column impulse{};  // M_fs q'_s with s the stopped coordinate
  if (axis == kTrolley) {
    impulse = {.x = 0, .phi = m.m12 * lost, .gamma = m.m13 * lost, .theta = m.m14 * lost};
  } else if (axis == kSlew) {
    impulse = {.x = m.m13 * lost, .phi = m.m23 * lost, .gamma = 0, .theta = m.m34 * lost};
  } else {  // the coupling of L'' in (2.17) and (2.19)
    impulse.x = -p.load_mass_kg * a.sf * a.ct * lost;
    impulse.gamma = p.load_mass_kg * p.tilt_cosine * s.trolley_m * a.st * lost;
  }
  Locks held = locks;
  held.axis[axis] = true;
  held.acceleration = {};
  const Column change = solve(m, impulse, held);
  State after = s;
  after.trolley_mps += change.x;
  after.radial_radps += change.phi;
  after.slew_radps += change.gamma;
  after.tangential_radps += change.theta;
  if (axis == kTrolley) after.trolley_mps = 0;
  if (axis == kSlew) after.slew_radps = 0;
  if (axis == kHoist) after.cable_mps = 0;
  return after;
}

Eigen::Matrix4d mass_matrix(const Parameters& p, const State& s) noexcept {
  const Mass m = mass(p, s, swing_angles(p, s));
  Eigen::Matrix4d matrix;
  matrix << m.m11, m.m12, m.m13, m.m14,  //
      m.m12, m.m22, m.m23, 0,            //
      m.m13, m.m23, m.m33, m.m34,        //
      m.m14, 0, m.m34, m.m44;
  return matrix;
}

Eigen::Matrix<double, 3, 4> load_jacobian(const Parameters& p, const State& s) noexcept {
  return load_jacobian(p, s, level_angles(p, s));
}

Eigen::Matrix<double, 3, 4> load_jacobian(const Parameters& p, const State& s,
                                          const motion::Angles<double>& a) noexcept {
  const double l = s.cable_m;
  Eigen::Matrix<double, 3, 4> j;
  j << p.tilt_cosine, -l * a.ct * a.cf, -l * a.st, l * a.st * a.sf,   //
      0, 0, p.tilt_cosine * s.trolley_m - l * a.ct * a.sf, l * a.ct,  //
      p.tilt_sine, l * a.ct * a.sf, 0, l * a.st * a.cf;
  return j;
}

Eigen::Vector3d load_velocity_mps(const Parameters& p, const State& s) noexcept {
  return load_velocity_mps(p, s, level_angles(p, s));
}

Eigen::Vector3d load_velocity_mps(const Parameters& p, const State& s, const Angles& a) noexcept {
  const Eigen::Vector4d rates{s.trolley_mps, s.radial_radps, s.slew_radps, s.tangential_radps};
  const Eigen::Vector3d along_cable{-a.ct * a.sf, a.st, -a.ct * a.cf};
  return load_jacobian(p, s, a) * rates + along_cable * s.cable_mps;
}

double energy_j(const Parameters& p, const State& s) noexcept {
  const double radius_m = p.tilt_cosine * s.trolley_m, height_m = p.tilt_sine * s.trolley_m;
  const double slewing = p.jib_inertia_kgm2 + p.trolley_mass_kg * radius_m * radius_m;
  const double kinetic =
      0.5 * (p.trolley_inertia_kg * s.trolley_mps * s.trolley_mps + slewing * s.slew_radps * s.slew_radps +
             p.load_mass_kg * load_velocity_mps(p, s).squaredNorm());
  const Angles a = level_angles(p, s);
  return kinetic + (p.trolley_mass_kg + p.load_mass_kg) * p.gravity_mps2 * height_m -
         p.load_mass_kg * p.gravity_mps2 * s.cable_m * a.ct * a.cf;
}

GantryAccelerations gantry_accelerations(const Parameters& p, const GantryState& s, double cable_mps2,
                                         double force_n) noexcept {
  const double m = p.load_mass_kg, sine = std::sin(s.swing_rad), cosine = std::cos(s.swing_rad);
  const double driving_n = force_n - m * cable_mps2 * sine - 2 * m * s.cable_mps * s.swing_radps * cosine +
                           m * s.cable_m * s.swing_radps * s.swing_radps * sine;
  const double free_swing = -p.gravity_mps2 * sine - 2 * s.cable_mps * s.swing_radps;  // L phi'' for x'' = 0
  const double trolley = (driving_n - m * cosine * free_swing) / (p.trolley_inertia_kg + m * sine * sine);
  return {.trolley_mps2 = trolley, .swing_radps2 = (free_swing - trolley * cosine) / s.cable_m};
}

LinearModel linear_translation(const Parameters& p, double cable_m) noexcept {
  const double load_mps2prad = p.load_to_trolley_ratio() * p.gravity_mps2;
  LinearModel model;
  model.a << 0, 0, 1, 0,        //
      0, 0, 0, 1,               //
      0, -load_mps2prad, 0, 0,  //
      0, -(p.gravity_mps2 + load_mps2prad) / cable_m, 0, 0;
  model.b << 0, 0, p.trolley_gain_mps2pv, p.trolley_gain_mps2pv / cable_m;
  return model;
}

LinearModel linear_rotation(const Parameters& p, double trolley_m, double cable_m) noexcept {
  const double inertia = 1 + p.trolley_to_jib_ratio() * trolley_m * trolley_m;
  const double load_radps2prad = p.load_to_jib_ratio() * p.gravity_mps2 * trolley_m / inertia;
  const double gain = p.slew_gain_radps2pv / inertia;
  LinearModel model;
  model.a << 0, 0, 1, 0,         //
      0, 0, 0, 1,                //
      0, load_radps2prad, 0, 0,  //
      0, -(p.gravity_mps2 + trolley_m * load_radps2prad) / cable_m, 0, 0;
  model.b << 0, 0, gain, -trolley_m * gain / cable_m;
  return model;
}

}  // namespace crane::plant
