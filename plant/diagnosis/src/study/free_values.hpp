#pragma once
/// The values of effects as one vector, with their bounds and steps.
#include <vector>

#include "study/hypothesis.hpp"

namespace crane::diagnosis {

struct FreeValues {
  std::vector<const FreeParameter*> parameters;
  Eigen::VectorXd values;
};

[[nodiscard]] FreeValues free_values_of(const Effects& effects);

/// @pre the same candidates
[[nodiscard]] bool same_values(const Effects& a, const Effects& b);

/// Damped step of the values `active` inside their bounds (Levenberg). A value whose step leads to its bound
/// or beyond is held at the bound, and the step of the others minimises the same parabola beside it (active
/// set).
/// @param h,g  curvature and gradient of the decrease of the loss
[[nodiscard]] Eigen::VectorXd bounded_step(const Eigen::MatrixXd& h, const Eigen::VectorXd& g,
                                           const FreeValues& free, double damping,
                                           std::vector<Eigen::Index> active);

}  // namespace crane::diagnosis
