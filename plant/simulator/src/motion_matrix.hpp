#pragma once
/// Newton matrix of a mechanical system for CVODE. With y = (q, q') and five coordinates q,
///   J = [0 I; A B],  A = d q''/d q,  B = d q''/d q'
/// so that (I - g J) d = r needs a 5x5 instead of a 10x10 factorisation:
///   (I - g B - g^2 A) d_v = r_v + g A r_p,   d_p = r_p + g d_v
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>

#include <Eigen/Core>

#include "crane/plant/state.hpp"

namespace crane::simulator {

inline constexpr int kCoordinates = plant::kStateSize / 2;
using CoordinateMatrix = Eigen::Matrix<double, kCoordinates, kCoordinates>;

/// identity * I + scale * J
struct MotionMatrix {
  double identity = 0, scale = 0;
  CoordinateMatrix by_position = CoordinateMatrix::Zero();  ///< A
  CoordinateMatrix by_rate = CoordinateMatrix::Zero();      ///< B
};

/// @return nullptr when out of memory
[[nodiscard]] SUNMatrix new_motion_matrix(SUNContext context);
[[nodiscard]] MotionMatrix& content_of(SUNMatrix matrix);

/// Direct solver for the matrix I - g J of CVODE. @return nullptr when out of memory
[[nodiscard]] SUNLinearSolver new_motion_solver(SUNContext context);

}  // namespace crane::simulator
