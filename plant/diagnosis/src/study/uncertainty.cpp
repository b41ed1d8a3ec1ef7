#include "study/uncertainty.hpp"

#include <algorithm>
#include <cmath>

#include "study/blocks.hpp"

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

/// Changes of the values when the fit omits a block, one row per block, about their mean.
MatrixXd jackknife(const BlockScores& at, const VectorXd& prior) {
  const Index values = prior.size();
  MatrixXd changes(at.by_block.rows(), values);
  for (Index block = 0; block < changes.rows(); ++block) {
    MatrixXd others = (at.curvature - at.curvature_of[static_cast<std::size_t>(block)]);
    others.diagonal() += prior;
    changes.row(block) = solve(others, at.by_block.row(block).transpose()).transpose();
  }
  return changes.rowwise() - changes.colwise().mean();
}

/// Degrees of freedom of a sum of squares of independent normal values with unequal variances
/// (F. E. Satterthwaite, Biometrics Bull. 2 (1946) 110). A squared value estimates its variance v, and its
/// square 3 v^2.
double freedom_of(const VectorXd& changes) {
  const double squares = changes.squaredNorm(), fourths = changes.array().square().square().sum();
  return fourths > 0 ? std::max(1.0, 3 * squares * squares / fourths - 1) : 1;
}

/// Scores and curvatures of some of the directions.
BlockScores selected(const BlockScores& scores, const std::vector<Index>& columns) {
  BlockScores some{scores.by_block(Eigen::all, columns), scores.curvature(columns, columns), {}};
  for (const MatrixXd& of_block : scores.curvature_of)
    some.curvature_of.emplace_back(of_block(columns, columns));
  return some;
}

}  // namespace

Effects Study::visible_inaccuracies_beside(const Effects& effects) const {
  ShowsIn parts;
  for (const Effect& effect : effects) {
    parts.drive = parts.drive || effect.candidate->drive;
    parts.load = parts.load || effect.candidate->load;
  }
  Effects beside = inaccuracies_beside(effects);
  std::erase_if(beside, [&](const Effect& inaccuracy) {
    return !(inaccuracy.candidate->drive && parts.drive) && !(inaccuracy.candidate->load && parts.load);
  });
  return beside;
}

double Study::zero_std_dev(Output swing) const { return least_noise_of(train_.runs, swing); }

std::vector<Study::HeldError> Study::zero_errors(Effects& effects) const {
  std::vector<HeldError> errors;
  for (const Output output : {kRadialSwing, kTangentialSwing}) {
    const double std_dev = zero_std_dev(output);
    const auto is_offset = [output](const Candidate& c) {
      return c.cause == "swing_offset" && c.axis == axis_of(output);
    };
    const auto candidate = std::ranges::find_if(candidates_, is_offset);
    if (std_dev == 0 || candidate == candidates_.end()) continue;
    const auto effect =
        std::ranges::find_if(effects, [&](const Effect& e) { return is_offset(*e.candidate); });
    const Index column = values_of({effects.begin(), effect});
    if (effect == effects.end()) effects.push_back({&*candidate, {candidate->parameters[0].null}});
    errors.push_back({column, std_dev});
  }
  return errors;
}

/// An error of the masses of the drives changes the estimate of the load mass by the same share. The rig file
/// states all masses with the same accuracy.
std::vector<Study::HeldError> Study::mass_errors(const Effects& effects) const {
  const auto bounded = std::ranges::find(inaccurate_, "payload_mass", &Candidate::cause);
  const auto payload = std::ranges::find_if(
      effects, [](const Effect& e) { return e.candidate->cause == "payload_mass" && e.candidate->drive; });
  if (bounded == inaccurate_.end() || payload == effects.end()) return {};
  return {{values_of({effects.begin(), payload}), std::sqrt(variance_of_bounds(bounded->parameters[0]))}};
}

Uncertainty Study::uncertainty_of(const Fitted& fitted) const {
  Uncertainty result;
  const Effects beside = visible_inaccuracies_beside(fitted.effects);
  result.effects = fitted.effects;
  result.effects.insert(result.effects.end(), beside.begin(), beside.end());
  Effects all = result.effects;
  std::vector<HeldError> held = zero_errors(all);
  for (const HeldError& error : mass_errors(fitted.effects)) held.push_back(error);
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
  const BlockScores of_all = block_scores(fitted.train, slopes(all, fitted.train));
  const BlockScores at = selected(of_all, free.columns);
  MatrixXd information = at.curvature;
  information.diagonal() += free.prior;
  const MatrixXd inverse = information.completeOrthogonalDecomposition().pseudoInverse();
  const MatrixXd changes = jackknife(at, free.prior);
  const double blocks = static_cast<double>(changes.rows());
  Index i = 0;
  for (const Effect& effect : fitted.effects)
    for (std::size_t k = 0; k < effect.values.size(); ++k, ++i) {
      ValueUncertainty& value = result.values.emplace_back();
      const VectorXd own = inverse.col(i);
      value.by_noise = std::sqrt(std::max(0.0, own[i]) * (effect.candidate->drive ? 2 : 1));
      const VectorXd line = own[i] > 0 ? VectorXd(own / own[i]) : VectorXd(VectorXd::Unit(own.size(), i));
      value.line = VectorXd::Zero(values);
      value.line(free.columns) = line;
      value.bend = line.dot(free.prior.cwiseProduct(line));
      value.std_dev = std::sqrt((blocks - 1) / blocks * changes.col(i).squaredNorm() +
                                own.dot(free.prior.cwiseProduct(own)));
      value.freedom = freedom_of(changes.col(i));
      for (const HeldError& error : held) {
        const double shift = own.dot(of_all.curvature(free.columns, error.column));
        value.systematic = std::hypot(value.systematic, shift * error.std_dev);
      }
    }
  return result;
}

}  // namespace crane::diagnosis
