#include <Eigen/Dense>
#include <cmath>

#include "fit/ascent.hpp"

namespace crane::innovations {
namespace {

constexpr int kNumbers = 4;  // angle and rate, radial and tangential

double& number(RunStart& start, int i) {
  return i < 2 ? start.lower_rad[static_cast<std::size_t>(i)]
               : start.lower_radps[static_cast<std::size_t>(i - 2)];
}

double value_of(const Problem& problem, const Hypothesis& h, std::size_t run,
                std::vector<double>* rows = nullptr) {
  Innovations out = innovations(problem, h, run);
  if (!out.finite) return -1e300;
  if (rows != nullptr) *rows = out.log_likelihood;
  return sum(out.log_likelihood);
}

/// One damped Newton step by outer products of the run's own scores. @return whether it helped
bool improve(const Problem& problem, Hypothesis& h, std::size_t run) {
  std::vector<double> rows;
  const double before = value_of(problem, h, run, &rows);
  if (rows.empty()) return false;
  const double angle = 0.002 * problem.scales.swing_rad, rate = angle * problem.scales.omega_radps;
  Eigen::MatrixXd s(static_cast<Eigen::Index>(rows.size()), kNumbers);
  for (int i = 0; i < kNumbers; ++i) {
    Hypothesis moved = h;
    const double step = i < 2 ? angle : rate;
    number(moved.starts[run], i) += step;
    std::vector<double> there;
    if (value_of(problem, moved, run, &there) < -1e299) return false;
    for (std::size_t k = 0; k < rows.size(); ++k)
      s(static_cast<Eigen::Index>(k), i) = (there[k] - rows[k]) / step;
  }
  Eigen::MatrixXd hessian = s.transpose() * s;
  for (int i = 0; i < kNumbers; ++i) hessian(i, i) += 1e-2 / std::pow(i < 2 ? angle : rate, 2) * 1e-4;
  const Eigen::VectorXd step = hessian.ldlt().solve(s.colwise().sum().transpose());
  for (const double share : {1.0, 0.3, 0.1}) {
    Hypothesis moved = h;
    for (int i = 0; i < kNumbers; ++i) number(moved.starts[run], i) += share * step[i];
    if (value_of(problem, moved, run) > before + 0.01) {
      h = std::move(moved);
      return true;
    }
  }
  return false;
}

}  // namespace

Fit fit_starts(const Problem& problem, Fit fit, int rounds) {
  if (!problem.double_pendulum(fit.at.values)) return fit;
  Hypothesis h = fit.at;
  h.starts.resize(problem.runs.size());
  for (std::size_t run = 0; run < problem.runs.size(); ++run)
    for (int i = 0; i < rounds && improve(problem, h, run); ++i) {
    }
  auto rows = log_likelihoods(problem, h);
  if (rows.empty()) return fit;
  const double value = sum(rows) + log_prior(problem, h.values);
  if (value > fit.value) fit = {std::move(h), value, std::move(rows)};
  return fit;
}

}  // namespace crane::innovations
