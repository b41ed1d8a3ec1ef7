#pragma once
/// Converts a force F on the load [N, slewing frame] to generalised forces Q = J^T F.
#include "crane/plant/matrices.hpp"

namespace crane::plant {

/// Adds the generalised forces of (x, phi, gamma, theta).
inline void add_generalised(const Eigen::Vector4d& q, Forces& sum) {
  sum.trolley_n += q[0];
  sum.radial_nm += q[1];
  sum.slew_nm += q[2];
  sum.tangential_nm += q[3];
}

/// @param cable  sines and cosines of the angles of the cable in the slewing frame
inline void add_load_force(const Parameters& crane, const State& state, const motion::Angles<double>& cable,
                           const Eigen::Vector3d& force_n, Forces& sum) {
  add_generalised(load_jacobian(crane, state, cable).transpose() * force_n, sum);
}

}  // namespace crane::plant
