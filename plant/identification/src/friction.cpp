#include "crane/identification/friction.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "crane/control/zero_phase.hpp"
#include "run_checks.hpp"

namespace crane::identification {
namespace {

constexpr std::size_t kFewestRows = 50;  // per direction
// Smallest spread / mean of the speed at which b and c can be distinguished.
constexpr double kSmallestSpeedSpread = 0.1;
constexpr double kLargestGainError = 0.1;  // largest accepted relative standard error of K_m
constexpr double kContradiction = 3;       // standard errors

// Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes (friction.hpp).

/// a, v and u of the rows k = 2, 3, ...
struct Rows {
  std::vector<double> acceleration, speed, volts;
};

Rows rows_of(const AxisRun& run, const FrictionOptions& options) {
  const auto filtered = [&options](const std::vector<double>& series, bool wanted) {
    if (!wanted || options.cutoff_ratio <= 0) return series;
    return control::zero_phase_butterworth(series, options.cutoff_ratio);
  };
  const auto x = filtered(run.position, true);
  const auto u = filtered(run.drive_v, options.filter_voltage);
  const double period_s = run.period_s;
  Rows rows;
  for (std::size_t k = 2; k < x.size(); ++k) {
    rows.acceleration.push_back((x[k] - 2 * x[k - 1] + x[k - 2]) / (period_s * period_s));
    if (options.regression == Regression::dissertation) {
      rows.speed.push_back(run.speed.empty() ? (x[k - 1] - x[k - 2]) / period_s : run.speed[k - 1]);
      rows.volts.push_back(u[k - 2]);
    } else {
      rows.speed.push_back(run.speed.empty() ? (x[k] - x[k - 2]) / (2 * period_s) : run.speed[k - 1]);
      rows.volts.push_back((u[k - 1] + u[k - 2]) / 2);
    }
  }
  return rows;
}

void check_options(const FrictionOptions& options) {
  if (!(options.zero_band >= 0))
    throw std::invalid_argument("zero_band = " + text(options.zero_band) + ": must be >= 0");
  if (!(options.cutoff_ratio >= 0 && options.cutoff_ratio < 0.5))
    throw std::invalid_argument("cutoff_ratio = " + text(options.cutoff_ratio) + ": must be in [0, 0.5)");
  if (options.gain) require_positive("gain", *options.gain);
}

/// Number and speeds of the rows of one direction.
struct Direction {
  std::size_t rows = 0;
  double sum = 0, sum_of_squares = 0;
  void add(double speed) {
    ++rows;
    sum += speed;
    sum_of_squares += speed * speed;
  }
  [[nodiscard]] double spread() const {
    const double mean = sum / static_cast<double>(rows);
    const double variance = sum_of_squares / static_cast<double>(rows) - mean * mean;
    return std::sqrt(std::max(0.0, variance)) / std::abs(mean);
  }
};

void check_directions(const Direction& positive, const Direction& negative, double zero_band) {
  if (positive.rows < kFewestRows && negative.rows < kFewestRows)
    throw IdentificationError("the axis hardly leaves the zero-velocity band of " + text(zero_band) +
                              " per second: excite it more, or narrow the band");
  const auto check = [&](const Direction& direction, const std::string& name) {
    if (direction.rows < kFewestRows)
      throw IdentificationError("only " + std::to_string(direction.rows) + " samples move in the " + name +
                                " direction, " + std::to_string(kFewestRows) +
                                " are needed to estimate its friction");
    if (direction.spread() < kSmallestSpeedSpread)
      throw IdentificationError("the " + name +
                                " direction has one speed only: viscous and Coulomb friction " +
                                "cannot be distinguished; use several speeds");
  };
  check(positive, "positive");
  check(negative, "negative");
}

/// Least-squares problem with all rows. Excluded rows are zero, so that the order of rows in time is kept.
struct Problem {
  Eigen::MatrixXd regressors;
  Eigen::VectorXd response;
  Direction positive, negative;
};

/// Problem (3.14) with the columns b+, b-, c+, c-, and 1/K_m when K_m is estimated.
Problem problem_of(const Rows& rows, const FrictionOptions& options) {
  const auto count = static_cast<Eigen::Index>(rows.speed.size());
  Problem problem;
  problem.regressors = Eigen::MatrixXd::Zero(count, options.gain ? 4 : 5);
  problem.response = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double v = rows.speed[k], a = rows.acceleration[k];
    const bool forward = v > options.zero_band, backward = v < -options.zero_band;
    if (!forward && !backward) continue;
    (forward ? problem.positive : problem.negative).add(v);
    problem.regressors(i, forward ? 0 : 1) = v;
    problem.regressors(i, forward ? 2 : 3) = forward ? 1 : -1;
    problem.response(i) = rows.volts[k];
    if (options.gain)
      problem.response(i) -= a / *options.gain;
    else
      problem.regressors(i, 4) = a;
  }
  return problem;
}

/// Standard errors by the delete-one-block jackknife with 20 blocks of neighbouring rows. The scatter of the
/// estimates includes the correlation of the residuals, for noise of any spectrum.
Eigen::VectorXd standard_errors(const Problem& problem) {
  constexpr Eigen::Index kBlocks = 20;
  const Eigen::Index columns = problem.regressors.cols(), rows = problem.regressors.rows();
  const Eigen::MatrixXd all = problem.regressors.transpose() * problem.regressors;
  const Eigen::VectorXd response = problem.regressors.transpose() * problem.response;
  Eigen::MatrixXd without(columns, kBlocks);
  for (Eigen::Index block = 0; block < kBlocks; ++block) {
    const Eigen::Index first = block * rows / kBlocks, count = (block + 1) * rows / kBlocks - first;
    const auto regressors = problem.regressors.middleRows(first, count);
    const Eigen::MatrixXd left = all - regressors.transpose() * regressors;
    const Eigen::VectorXd left_response =
        response - regressors.transpose() * problem.response.segment(first, count);
    without.col(block) = left.ldlt().solve(left_response);
  }
  const Eigen::MatrixXd scatter = without.colwise() - without.rowwise().mean();
  return (scatter.rowwise().squaredNorm() * (kBlocks - 1.0) / kBlocks).cwiseSqrt();
}

Estimate gain_of(double inverse, double standard_error) {
  if (!(inverse > 0) || standard_error > kLargestGainError * inverse)
    throw IdentificationError("the data do not determine K_m (1/K_m = " + text(inverse) + " +- " +
                              text(standard_error) + "): excite with more acceleration, or give K_m");
  return {1 / inverse, standard_error / (inverse * inverse)};
}

}  // namespace

FrictionEstimate estimate_friction(const AxisRun& run, const FrictionOptions& options) {
  check_options(options);
  check_series(run);
  if (std::ranges::max(run.drive_v) == std::ranges::min(run.drive_v))
    throw IdentificationError("the drive voltage is constant: excite the axis");
  const Problem problem = problem_of(rows_of(run, options), options);
  check_directions(problem.positive, problem.negative, options.zero_band);
  const Eigen::VectorXd solution = problem.regressors.colPivHouseholderQr().solve(problem.response);
  const Eigen::VectorXd residual = problem.response - problem.regressors * solution;
  const std::size_t rows = problem.positive.rows + problem.negative.rows;
  const Eigen::VectorXd errors = standard_errors(problem);
  const auto estimate = [&](Eigen::Index i) { return Estimate{solution(i), errors(i)}; };
  FrictionEstimate result;
  result.viscous_positive = estimate(0);
  result.viscous_negative = estimate(1);
  result.coulomb_positive = estimate(2);
  result.coulomb_negative = estimate(3);
  result.gain =
      options.gain ? Estimate{*options.gain, 0} : gain_of(estimate(4).value, estimate(4).standard_error);
  result.rows_positive = problem.positive.rows;
  result.rows_negative = problem.negative.rows;
  result.residual_rms_v = residual.norm() / std::sqrt(static_cast<double>(rows));
  return result;
}

std::vector<std::string> contradictions(const FrictionEstimate& estimate) {
  std::vector<std::string> found;
  const auto check = [&found](const char* name, const Estimate& value) {
    if (value.value < -kContradiction * value.standard_error)
      found.push_back(std::string{name} + " = " + text(value.value) + " +- " + text(value.standard_error) +
                      ": friction cannot drive the axis; check the signs of voltage and position, and K_m");
  };
  check("b+/K_m", estimate.viscous_positive);
  check("b-/K_m", estimate.viscous_negative);
  check("c+/K_m", estimate.coulomb_positive);
  check("c-/K_m", estimate.coulomb_negative);
  return found;
}

}  // namespace crane::identification
