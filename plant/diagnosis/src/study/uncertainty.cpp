#include "study/uncertainty.hpp"

#include <algorithm>
#include <cmath>

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Index values_of(const Effects& effects) {
  Index count = 0;
  for (const Effect& effect : effects) count += static_cast<Index>(effect.values.size());
  return count;
}

/// Variance of a uniform distribution between the bounds of an inaccuracy (JCGM 100:2008, 4.3.7).
double variance_of_bounds(const FreeParameter& p) { return std::pow(0.5 * (p.high - p.low), 2) / 3; }

/// Columns of the values that the fit has determined: those of the effects, and the inaccuracies inside their
/// bounds.
struct Determined {
  std::vector<Index> columns;
  VectorXd prior;  ///< by column: information of the bounds of the inaccuracies; 0 for the effects
};

/// The scores of blocks correlate up to this number of correlation times of the disturbance: a disturbance
/// at the end of a block acts on the unknown start of the next one. Beyond, its correlation is below e^-2.
constexpr double kCorrelationTimes = 2;

/// By block of the drives, then of the load.
std::vector<std::size_t> followers_of(const WhitenedData& data, const Nuisance& nuisance) {
  const auto longest_s = [](const std::vector<Disturbance>& disturbances) {
    double time_s = 0;
    for (const Disturbance& disturbance : disturbances) time_s = std::max(time_s, disturbance.correlation_s);
    return time_s;
  };
  const double of_drive_s = std::max(longest_s(nuisance.drive), longest_s(nuisance.equation_error));
  std::vector<std::size_t> followers = followers_within(data.drive(), kCorrelationTimes * of_drive_s);
  const auto more = followers_within(data.load(), kCorrelationTimes * longest_s(nuisance.load));
  followers.insert(followers.end(), more.begin(), more.end());
  return followers;
}

/// Changes of the values when the fit omits a block, one row per block, about their mean.
MatrixXd jackknife(const BlockScores& at, const VectorXd& prior) {
  const Index values = prior.size();
  MatrixXd changes(at.by_block.rows(), values);
  for (Index block = 0; block < changes.rows(); ++block) {
    MatrixXd others = kCurvaturePerWeight * (at.curvature - at.curvature_of[static_cast<std::size_t>(block)]);
    others.diagonal() += prior;
    changes.row(block) = solve(others, at.by_block.row(block).transpose()).transpose();
  }
  return changes.rowwise() - changes.colwise().mean();
}

/// Least ratio of an estimated variance to the true one for which the estimate is corrected.
constexpr double kLeastEstimated = 0.5;

/// Variance of the sum of the changes of a value, with its degrees of freedom.
struct SumVariance {
  double variance = 0, freedom = 1;
  double independent = 0;  ///< variance for independent blocks
};

/// Sum of the squares and of the products of correlated blocks (truncated kernel: H. White, Asymptotic Theory
/// for Econometricians, 1984, VI), at least the sum of the squares. At the fit, the changes sum to 0, which
/// decreases the expectation of the products: with the variances v of the blocks, by the sum of v_b v_c over
/// all variances. The degrees of freedom are those of a quadratic form of independent normal values
/// (F. E. Satterthwaite, Biometrics Bull. 2 (1946) 110). A squared value estimates its variance v, and its
/// square 3 v^2.
SumVariance variance_of_sum(const VectorXd& changes, const std::vector<std::size_t>& followers) {
  const VectorXd squares = changes.cwiseAbs2();
  double products = 0, of_pairs = 0;
  for (Index b = 0; b < changes.size(); ++b) {
    const auto count = static_cast<Index>(followers[static_cast<std::size_t>(b)]);
    products += 2 * changes[b] * changes.segment(b + 1, count).sum();
    of_pairs += 2 * squares[b] * squares.segment(b + 1, count).sum();
  }
  const double independent = squares.sum();
  if (independent == 0) return {};
  const double estimated = std::max(kLeastEstimated, 1 - of_pairs / (independent * independent));
  const double variance = std::max(independent, (independent + products) / estimated);
  const double freedom = variance * variance / (squares.squaredNorm() / 3 + of_pairs) - 1;
  return {variance, std::max(1.0, freedom), independent};
}

/// Scores and curvatures of some of the directions.
BlockScores selected(const BlockScores& scores, const std::vector<Index>& columns) {
  BlockScores some{scores.by_block(Eigen::all, columns), scores.curvature(columns, columns), {}};
  for (const MatrixXd& of_block : scores.curvature_of)
    some.curvature_of.emplace_back(of_block(columns, columns));
  return some;
}

/// Error of a quantity that the fit holds constant: the column of the slope of this quantity, and the
/// standard deviation of the error. Three kinds of quantity have such an error: the zero of a swing sensor,
/// which is known to one count only; the masses of the drives, because the data show only the ratio of the
/// load mass to them; an inaccuracy whose fitted value is at its bound.
struct HeldError {
  Index column = 0;
  double std_dev = 0;
};

/// Errors of the zeros of the swing sensors. Appends an effect for each zero that no effect describes.
std::vector<HeldError> zero_errors(const Study& study, Effects& effects) {
  std::vector<HeldError> errors;
  for (const Output output : {kRadialSwing, kTangentialSwing}) {
    const double std_dev = study.zero_std_dev(output);
    const auto is_offset = [output](const Candidate& c) {
      return c.cause == "swing_offset" && c.axis == axis_of(output);
    };
    const auto candidate = std::ranges::find_if(study.candidates(), is_offset);
    if (std_dev == 0 || candidate == study.candidates().end()) continue;
    const auto effect =
        std::ranges::find_if(effects, [&](const Effect& e) { return is_offset(*e.candidate); });
    const Index column = values_of({effects.begin(), effect});
    if (effect == effects.end()) effects.push_back({&*candidate, {candidate->parameters[0].null}});
    errors.push_back({column, std_dev});
  }
  return errors;
}

/// Errors of the masses of the drives, if the load mass is a value of the effects: they change the estimate
/// of the load mass by the same share. The rig file states all masses with the same accuracy.
std::vector<HeldError> mass_errors(const Study& study, const Effects& effects) {
  const auto bounded = std::ranges::find_if(
      study.no_inaccuracies(), [](const Effect& e) { return e.candidate->cause == "payload_mass"; });
  const auto payload = std::ranges::find_if(
      effects, [](const Effect& e) { return e.candidate->cause == "payload_mass" && e.candidate->drive; });
  if (bounded == study.no_inaccuracies().end() || payload == effects.end()) return {};
  return {{values_of({effects.begin(), payload}),
           std::sqrt(variance_of_bounds(bounded->candidate->parameters[0]))}};
}

}  // namespace

Uncertainty uncertainty_of(const WhitenedData& data, const Fitted& fitted) {
  Uncertainty result;
  const Effects beside = visible_beside(data.nuisance().inaccuracies, fitted.effects);
  result.effects = fitted.effects;
  result.effects.insert(result.effects.end(), beside.begin(), beside.end());
  Effects all = result.effects;
  std::vector<HeldError> held = zero_errors(data.study(), all);
  for (const HeldError& error : mass_errors(data.study(), fitted.effects)) held.push_back(error);
  const Index own_values = values_of(fitted.effects), values = values_of(result.effects);
  Determined free;
  std::vector<double> prior(static_cast<std::size_t>(own_values), 0.0);
  for (Index i = 0; i < own_values; ++i) free.columns.push_back(i);
  Index next = own_values;
  for (const Effect& inaccuracy : beside)
    for (std::size_t k = 0; k < inaccuracy.values.size(); ++k, ++next) {
      const FreeParameter& p = inaccuracy.candidate->parameters[k];
      const double variance = variance_of_bounds(p);
      if (inaccuracy.values[k] > p.low && inaccuracy.values[k] < p.high) {
        free.columns.push_back(next);
        prior.push_back(1 / variance);
      } else {
        held.push_back({next, std::sqrt(variance)});
      }
    }
  free.prior = Eigen::Map<const VectorXd>(prior.data(), static_cast<Index>(prior.size()));
  const BlockScores of_all =
      data.scores(fitted.train, data.whitened(data.plain_slopes(all, fitted.train), fitted.train));
  const BlockScores at = selected(of_all, free.columns);
  MatrixXd information = kCurvaturePerWeight * at.curvature;
  information.diagonal() += free.prior;
  const MatrixXd inverse = information.completeOrthogonalDecomposition().pseudoInverse();
  const MatrixXd changes = jackknife(at, free.prior);
  const std::vector<std::size_t> followers = followers_of(data, fitted.nuisance);
  const double blocks = static_cast<double>(changes.rows());
  Index i = 0;
  for (const Effect& effect : fitted.effects)
    for (std::size_t k = 0; k < effect.values.size(); ++k, ++i) {
      ValueUncertainty& value = result.values.emplace_back();
      const VectorXd own = inverse.col(i);
      value.by_noise =
          std::sqrt(kScorePerCurvature * std::max(0.0, own[i]) * (effect.candidate->drive ? 2 : 1));
      const VectorXd line = own[i] > 0 ? VectorXd(own / own[i]) : VectorXd(VectorXd::Unit(own.size(), i));
      value.line = VectorXd::Zero(values);
      value.line(free.columns) = line;
      value.bend = line.dot(free.prior.cwiseProduct(line));
      const SumVariance by_blocks = variance_of_sum(changes.col(i), followers);
      value.std_dev =
          std::sqrt((blocks - 1) / blocks * by_blocks.variance + own.dot(free.prior.cwiseProduct(own)));
      value.freedom = by_blocks.freedom;
      if (by_blocks.independent > 0)
        value.by_correlation = std::sqrt(by_blocks.variance / by_blocks.independent);
      for (const HeldError& error : held) {
        const double shift = kCurvaturePerWeight * own.dot(of_all.curvature(free.columns, error.column));
        value.systematic = std::hypot(value.systematic, shift * error.std_dev);
      }
    }
  return result;
}

}  // namespace crane::diagnosis
