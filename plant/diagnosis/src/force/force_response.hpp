#pragma once
/// What an extra force does to the residual of a window, along the measured motion: a drive that moves
/// answers as a free mass, one that stands does not; a pendulum's answer, once free motion is taken out, is
/// the force times a constant. In units of its own: patterns of force are told by their shape.
#include "shooting/problem.hpp"

namespace crane::diagnosis {

/// Slower than this [m/s or rad/s], an axis with friction stands.
inline constexpr double kStands = 0.01;

/// How well patterns of force explain the residual of a window: slope' weighted residual and slope' weighted
/// slope.
struct Explained {
  Eigen::VectorXd pull;
  Eigen::MatrixXd curvature;
  /// Decrease of the loss that the amplitudes x make.
  [[nodiscard]] double gain(const Eigen::VectorXd& x) const { return 2 * x.dot(pull) - x.dot(curvature * x); }
  Explained& operator+=(const Explained& other);
  Explained& operator-=(const Explained& other);
};

/// Of cosine and sine, the two patterns of a wave, as the residual has them best.
[[nodiscard]] Eigen::Vector2d wave_amplitude(const Explained& wave);

/// @param output index into the problem's outputs
/// @param forces on it, row x pattern
[[nodiscard]] Explained explained(const Problem& problem, const Fits& fits, std::size_t window,
                                  std::size_t output, Eigen::MatrixXd forces);

}  // namespace crane::diagnosis
