#include "force/force_response.hpp"

#include <cmath>

#include "robust.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of a mass that forgets its speed where the axis stands, in place.
void push(const Problem& problem, std::size_t at, std::size_t output, MatrixXd& forces) {
  const Window& window = problem.windows()[at];
  const PreparedRun& run = problem.runs()[window.run];
  const Disturbance& disturbance = problem.disturbances()[output];
  const std::vector<double>& rate = run.motion[problem.outputs()[output]].rate;
  const double h = run.run.period_s, kept = std::exp(-disturbance.damping_ps * h);
  Eigen::RowVectorXd way = Eigen::RowVectorXd::Zero(forces.cols()), speed = way;
  for (Index k = 0; k < forces.rows(); ++k) {
    const Eigen::RowVectorXd force = forces.row(k);
    forces.row(k) = way;
    const bool stands =
        disturbance.sticks && std::abs(rate[window.first + static_cast<std::size_t>(k)]) < kStands;
    const Eigen::RowVectorXd before = speed;
    if (stands)
      speed.setZero();
    else
      speed = kept * speed + h * force;
    way += 0.5 * h * (before + speed);
  }
}

}  // namespace

Explained& Explained::operator+=(const Explained& other) {
  pull += other.pull;
  curvature += other.curvature;
  return *this;
}

Explained& Explained::operator-=(const Explained& other) {
  pull -= other.pull;
  curvature -= other.curvature;
  return *this;
}

Eigen::Vector2d wave_amplitude(const Explained& wave) {
  const Eigen::Matrix2d h = wave.curvature;
  const Eigen::Matrix2d regular = h + (1e-9 * h.trace() + 1e-12) * Eigen::Matrix2d::Identity();
  return regular.inverse() * wave.pull;
}

Explained explained(const Problem& problem, const Fits& fits, std::size_t window, std::size_t output,
                    MatrixXd forces) {
  const Index rows = forces.rows(), first = static_cast<Index>(output) * rows;
  if (problem.part() == Part::drive) push(problem, window, output, forces);
  problem.whitener(output, window).apply(forces);
  const auto basis = fits[window].basis.middleRows(first, rows);
  forces -= basis * (basis.transpose() * forces).eval();
  const VectorXd residual = fits[window].residual.segment(first, rows);
  const VectorXd weights = weights_of(residual);
  return {forces.transpose() * weights.cwiseProduct(residual),
          forces.transpose() * weights.asDiagonal() * forces};
}

}  // namespace crane::diagnosis
