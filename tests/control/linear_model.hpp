#pragma once
/// The linear models (2.28)-(2.31) of H. M. Omar in closed loop with a law: the oracle of the tests of poles.
#include <Eigen/Dense>
#include <algorithm>
#include <complex>
#include <memory>
#include <vector>

#include "crane/control/law.hpp"

namespace crane::control {

/// State of one axis: position, speed, swing, swing rate.
enum class Motion { trolley, slew };

inline Measurement measurement(const Design& design, Motion motion, double trolley_position_m,
                               const Eigen::Vector4d& state) {
  Measurement measured;
  measured.position = {trolley_position_m, 0, design.cable_length_m};
  const bool trolley = motion == Motion::trolley;
  const std::size_t axis = trolley ? kTrolley : kSlew;
  measured.position[axis] = trolley ? trolley_position_m + state(0) : state(0);
  measured.speed[axis] = state(1);
  (trolley ? measured.swing_radial_rad : measured.swing_tangential_rad) = state(2);
  (trolley ? measured.swing_radial_radps : measured.swing_tangential_radps) = state(3);
  return measured;
}

/// Sum of the volts of both laws of a controller.
inline double volts(const Controller& controller, const Design& design, Motion motion,
                    double trolley_position_m, const Eigen::Vector4d& state) {
  const auto measured = measurement(design, motion, trolley_position_m, state);
  Reference reference;
  reference[kTrolley].position = trolley_position_m;
  reference[kHoist].position = design.cable_length_m;
  double sum = 0;
  for (auto* make : {controller.make_tracking, controller.make_anti_swing}) {
    const auto law = make(design);
    law->reset(measured);
    sum += law->step(measured, reference).drive_v[motion == Motion::trolley ? kTrolley : kSlew];
  }
  return sum;
}

/// Closed loop at constant x and L, where the controllers are linear: unit inputs give the exact gains.
inline Eigen::Matrix4d closed_loop(const Controller& controller, const Design& design, Motion motion,
                                   double x) {
  const auto& c = design.crane;
  const double g = c.gravity_mps2, length = design.cable_length_m;
  Eigen::RowVector4d acceleration = Eigen::RowVector4d::Zero();
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector4d probe = Eigen::Vector4d::Unit(i);
    acceleration(i) = volts(controller, design, motion, x, probe);
  }
  double drag = 1;  // swing'' per drive acceleration, times L
  if (motion == Motion::trolley) {
    acceleration *= c.trolley_gain_mps2pv;
    acceleration(2) -= c.load_mass_kg / c.trolley_inertia_kg * g;
  } else {
    acceleration *= c.slew_gain_radps2pv;
    acceleration(2) += c.load_mass_kg / c.jib_inertia_kgm2 * g * x;
    acceleration /= 1 + c.trolley_mass_kg / c.jib_inertia_kgm2 * x * x;
    drag = -x;
  }
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  a(0, 1) = 1;
  a.row(1) = acceleration;
  a(2, 3) = 1;
  a.row(3) = drag * acceleration / length;
  a(3, 2) -= g / length;
  return a;
}

/// Largest distance between expected and computed roots; each expected root is paired in turn with the
/// nearest remaining root.
inline double worst_mismatch(const Eigen::Matrix4d& a, const std::vector<std::complex<double>>& expected) {
  const Eigen::Vector4cd poles = a.eigenvalues();
  std::vector<std::complex<double>> left(poles.data(), poles.data() + poles.size());
  double worst = 0;
  for (const auto& root : expected) {
    const auto nearest = std::min_element(left.begin(), left.end(), [&](const auto& p, const auto& q) {
      return std::abs(p - root) < std::abs(q - root);
    });
    worst = std::max(worst, std::abs(*nearest - root));
    left.erase(nearest);
  }
  return worst;
}

}  // namespace crane::control
