#pragma once
/// Matrices of the equations of motion (equations.hpp). Terms, linear designs and tests use them.
#include <Eigen/Core>

#include "crane/plant/equations.hpp"
#include "crane/plant/motion_terms.hpp"

namespace crane::plant {

/// Mass matrix M(q), symmetric; rows and columns (x, phi, gamma, theta).
[[nodiscard]] Eigen::Matrix4d mass_matrix(const Parameters& parameters, const State& state) noexcept;

/// Jacobian J = d r_L' / d q' of the load's velocity, in the slewing frame, which turns with the jib and has
/// a vertical third axis (the jib frame without tilt); columns (x, phi, gamma, theta). A force F on the load
/// has the generalised forces J^T F.
[[nodiscard]] Eigen::Matrix<double, 3, 4> load_jacobian(const Parameters& parameters,
                                                        const State& state) noexcept;
/// @param level  sines and cosines of the angles of the cable in the slewing frame
[[nodiscard]] Eigen::Matrix<double, 3, 4> load_jacobian(const Parameters& parameters, const State& state,
                                                        const motion::Angles<double>& level) noexcept;

/// Velocity of the load relative to the ground, including the cable speed, in the slewing frame [m/s],
/// (2.12).
[[nodiscard]] Eigen::Vector3d load_velocity_mps(const Parameters& parameters, const State& state) noexcept;
[[nodiscard]] Eigen::Vector3d load_velocity_mps(const Parameters& parameters, const State& state,
                                                const motion::Angles<double>& level) noexcept;

/// Linear model of one drive with its swing: d(state)/dt = a state + b volts, with the state (x, phi, x',
/// phi') or (gamma, theta, gamma', theta').
struct LinearModel {
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
};
/// Trolley and radial swing, (2.28), (2.29).
[[nodiscard]] LinearModel linear_translation(const Parameters& parameters, double cable_m) noexcept;
/// Slew axis and tangential swing at a fixed trolley position, (2.30), (2.31), with M_r = M_j / J_o, m_r = m
/// / J_o.
[[nodiscard]] LinearModel linear_rotation(const Parameters& parameters, double trolley_m,
                                          double cable_m) noexcept;

}  // namespace crane::plant
