#pragma once
/// Converts a force F on the load [N, slewing frame] to generalised forces Q = J^T F.
#include "crane/plant/matrices.hpp"

namespace crane::plant {

inline void add_load_force(const Parameters& crane, const State& state, const Eigen::Vector3d& force_n,
                           Forces& sum) {
  const Eigen::Vector4d q = load_jacobian(crane, state).transpose() * force_n;
  sum.trolley_n += q[0];
  sum.radial_nm += q[1];
  sum.slew_nm += q[2];
  sum.tangential_nm += q[3];
}

}  // namespace crane::plant
