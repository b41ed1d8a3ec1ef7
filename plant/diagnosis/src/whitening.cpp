#include "whitening.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What moves: a drive with viscous friction (natural 0) or a pendulum.
struct Response {
  double natural_radps = 0, damping_ps = 0;
  /// Position t after a unit acceleration began.
  [[nodiscard]] double to_step(double t) const {
    if (natural_radps > 0) return (1 - std::cos(natural_radps * t)) / (natural_radps * natural_radps);
    if (damping_ps * t < 1e-3) return 0.5 * t * t;
    return (t - from_speed(t)) / damping_ps;
  }
  /// Position t after a start with unit speed.
  [[nodiscard]] double from_speed(double t) const {
    if (natural_radps > 0) return std::sin(natural_radps * t) / natural_radps;
    return damping_ps * t < 1e-3 ? t : (1 - std::exp(-damping_ps * t)) / damping_ps;
  }
  [[nodiscard]] double from_place(double t) const {
    return natural_radps > 0 ? std::cos(natural_radps * t) : 1;
  }
};

/// Response at row k to a unit acceleration held over [j, j + 1].
MatrixXd response(Index rows, double period_s, const Response& motion) {
  MatrixXd h = MatrixXd::Zero(rows, rows);
  for (Index k = 1; k < rows; ++k) {
    const double t = static_cast<double>(k) * period_s;
    const double value = motion.to_step(t) - motion.to_step(t - period_s);
    for (Index row = k; row < rows; ++row) h(row, row - k) = value;
  }
  return h;
}

MatrixXd coloured(Index rows, double period_s, double correlation_s) {
  MatrixXd r(rows, rows);
  const double rho = correlation_s > 0 ? std::exp(-period_s / correlation_s) : 0;
  for (Index i = 0; i < rows; ++i)
    for (Index j = 0; j < rows; ++j)
      r(i, j) = i == j ? 1 : std::pow(rho, std::abs(static_cast<double>(i - j)));
  return r;
}

/// Orthonormal basis of what a free start cannot explain.
MatrixXd unexplained(Index rows, double period_s, const Response& motion) {
  MatrixXd z(rows, 2);
  for (Index k = 0; k < rows; ++k) {
    const double t = static_cast<double>(k) * period_s;
    z(k, 0) = motion.from_place(t);
    z(k, 1) = motion.from_speed(t);
  }
  const Eigen::HouseholderQR<MatrixXd> qr(z);
  return (qr.householderQ() * MatrixXd::Identity(rows, rows)).rightCols(rows - 2);
}

/// Minus twice the log likelihood of noise 1 and disturbance `ratio`, the common scale profiled out.
struct Likelihood {
  double value = std::numeric_limits<double>::infinity();
  double variance = 1;
};

struct Spectrum {
  VectorXd eigenvalues;  ///< of Q^T H R H^T Q
  VectorXd energy;       ///< mean square of the residuals along its eigenvectors
  double windows = 0;
};

Likelihood likelihood(const Spectrum& s, double ratio) {
  const Eigen::ArrayXd variance = 1 + ratio * ratio * s.eigenvalues.array().max(0);
  const double scale = (s.energy.array() / variance).mean();
  if (!(scale > 0)) return {};
  return {s.windows * (variance.log().sum() + static_cast<double>(variance.size()) * std::log(scale)), scale};
}

}  // namespace

Whitener::Whitener(const std::vector<VectorXd>& residuals, double period_s, double natural_radps)
    : period_s_(period_s), natural_radps_(natural_radps) {
  // All windows count with their first `rows` rows; a few hundred are enough for three numbers.
  Index rows = 100;
  for (const VectorXd& r : residuals) rows = std::min(rows, r.size());
  double best = std::numeric_limits<double>::infinity();
  const auto dampings = natural_radps > 0 ? std::vector<double>{0} : std::vector<double>{0, 1, 4, 12};
  for (const double damping_ps : dampings) {
    const Response motion{natural_radps, damping_ps};
    const MatrixXd q = unexplained(rows, period_s, motion),
                   h = q.transpose() * response(rows, period_s, motion);
    for (const double correlation_s : {0.0, 0.05, 0.1, 0.2, 0.5, 1.0}) {
      const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(h * coloured(rows, period_s, correlation_s) *
                                                          h.transpose());
      Spectrum spectrum{eigen.eigenvalues(), VectorXd::Zero(rows - 2), static_cast<double>(residuals.size())};
      for (const VectorXd& r : residuals)
        spectrum.energy += (eigen.eigenvectors().transpose() * (q.transpose() * r.head(rows))).cwiseAbs2();
      spectrum.energy /= static_cast<double>(residuals.size());
      for (double ratio = 1e-1; ratio < 1e7; ratio *= 1.5) {
        const Likelihood found = likelihood(spectrum, ratio);
        if (found.value >= best) continue;
        best = found.value;
        const double noise = std::sqrt(found.variance);
        disturbance_ = {noise, ratio * noise, correlation_s, damping_ps};
      }
    }
  }
  disturbance_.noise = std::max(disturbance_.noise, kLeastNoise);
  for (const VectorXd& r : residuals) prepare(r.size());
}

void Whitener::prepare(Index rows) {
  if (factors_.contains(rows)) return;
  const MatrixXd g = response(rows, period_s_, {natural_radps_, disturbance_.damping_ps});
  MatrixXd s = disturbance_.acceleration * disturbance_.acceleration *
               (g * coloured(rows, period_s_, disturbance_.correlation_s) * g.transpose());
  s.diagonal().array() += disturbance_.noise * disturbance_.noise;
  factors_[rows] = s.llt().matrixL();
}

const MatrixXd& Whitener::factor(Index rows) const { return factors_.at(rows); }

void Whitener::apply(Eigen::Ref<MatrixXd> x) const {
  factor(x.rows()).triangularView<Eigen::Lower>().solveInPlace(x);
}

}  // namespace crane::diagnosis
