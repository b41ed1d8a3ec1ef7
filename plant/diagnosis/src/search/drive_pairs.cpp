#include "search/drive_pairs.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>
#include <utility>

#include "robust.hpp"
#include "study/blocks.hpp"
#include "study/descent.hpp"
#include "study/free_values.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Number of pairs of an axis that are fitted to the equation error.
constexpr std::size_t kFitted = 6;

/// A shape whose slopes along the measured motion are known: consecutive columns of the regressors.
struct Regressor {
  const Candidate* candidate = nullptr;
  const Shape* shape = nullptr;
  Index first = 0, columns = 0;
};

struct Regression {
  std::vector<Regressor> regressors;
  MatrixXd information;  ///< X' W X
  VectorXd score;        ///< X' W e
};

VectorXd joined(const std::vector<VectorXd>& parts) {
  Index rows = 0;
  for (const VectorXd& part : parts) rows += part.size();
  VectorXd all(rows);
  Index next = 0;
  for (const VectorXd& part : parts) {
    all.segment(next, part.size()) = part;
    next += part.size();
  }
  return all;
}

/// All shapes with small probes of the candidates of an axis.
Regression regression_of(const WhitenedData& data, const Evaluation& base, const ProbeSlopes& known,
                         const std::string& axis) {
  const std::vector<Candidate>& candidates = data.study().candidates();
  const VectorXd residual = joined(base.equation_error), weights = weights_of(residual);
  Regression all;
  std::vector<VectorXd> columns;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (!candidates[c].drive || candidates[c].axis != axis) continue;
    for (const Shape& shape : candidates[c].shapes) {
      if (shape.large_probe) continue;
      std::vector<VectorXd> of_shape;
      for (const plant::TermSetting& probe : shape.probes)
        if (const ProbeSlopes::Known* slopes = known.find(c, probe); slopes != nullptr && slopes->drive)
          of_shape.push_back(joined(data.body().equation_error.whitened(slopes->drive->equation_error)));
      if (of_shape.size() != shape.probes.size()) continue;
      all.regressors.push_back(
          {&candidates[c], &shape, static_cast<Index>(columns.size()), static_cast<Index>(of_shape.size())});
      std::ranges::move(of_shape, std::back_inserter(columns));
    }
  }
  MatrixXd x(residual.size(), static_cast<Index>(columns.size()));
  for (Index i = 0; i < x.cols(); ++i) x.col(i) = columns[static_cast<std::size_t>(i)];
  const MatrixXd weighted = weights.asDiagonal() * x;
  all.information = x.transpose() * weighted;
  all.score = weighted.transpose() * residual;
  return all;
}

struct LinearPair {
  Effects effects;
  double gain = 0;
};

/// Least squares of two shapes. @return gain 0 if an amount has a sign that its candidate excludes
LinearPair pair_of(const Regression& regression, const Regressor& a, const Regressor& b) {
  std::vector<Index> columns;
  for (const Regressor* of : {&a, &b})
    for (Index i = 0; i < of->columns; ++i) columns.push_back(of->first + i);
  const MatrixXd information = regression.information(columns, columns);
  const VectorXd score = regression.score(columns), amounts = solve(information, score);
  LinearPair pair;
  for (const Regressor* of : {&a, &b}) {
    const double* const first = amounts.data() + (of == &a ? 0 : a.columns);
    const FreeParameter& size = of->candidate->parameters.front();
    if (of->candidate->one_sided && (*first > 0) != (size.high > size.null)) return {};
    pair.effects.push_back(
        {of->candidate, of->candidate->of_amounts(*of->shape, {first, first + of->columns})});
  }
  pair.gain = score.dot(amounts);
  return pair;
}

/// The best pair of shapes for each pair of candidates, in the order of decreasing gain.
std::vector<LinearPair> linear_pairs_of(const Regression& regression) {
  std::vector<LinearPair> best;
  for (std::size_t i = 0; i < regression.regressors.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Regressor &a = regression.regressors[j], &b = regression.regressors[i];
      if (a.candidate == b.candidate) continue;
      LinearPair pair = pair_of(regression, a, b);
      if (!(pair.gain > 0)) continue;
      const auto same = std::ranges::find_if(best, [&](const LinearPair& other) {
        return other.effects[0].candidate == a.candidate && other.effects[1].candidate == b.candidate;
      });
      if (same == best.end())
        best.push_back(std::move(pair));
      else if (same->gain < pair.gain)
        *same = std::move(pair);
    }
  std::ranges::sort(best, std::greater{}, &LinearPair::gain);
  return best;
}

/// Gauss-Newton fit to the equation error alone.
class EquationErrorFit {
 public:
  EquationErrorFit(const WhitenedData& data, Effects start) : data_(data), effects_(std::move(start)) {
    residual_ = residual_of(effects_);
    while (step()) {
    }
  }
  [[nodiscard]] const Effects& effects() const { return effects_; }
  [[nodiscard]] double loss() const { return loss_of(residual_); }

 private:
  [[nodiscard]] VectorXd residual_of(const Effects& effects) const {
    return joined(data_.body().equation_error.residuals(replays_of(data_.runs(), data_.with(effects))));
  }

  [[nodiscard]] MatrixXd slopes(const FreeValues& from) const {
    MatrixXd x(residual_.size(), from.values.size());
    for (Index i = 0; i < x.cols(); ++i) {
      const double step = difference_step(*from.parameters[static_cast<std::size_t>(i)], from.values[i]);
      x.col(i) = (residual_ - residual_of(moved(effects_, step * VectorXd::Unit(x.cols(), i)))) / step;
    }
    return x;
  }

  /// @return whether a step has decreased the loss by kLeastGain
  bool step() {
    const FreeValues from = free_values_of(effects_);
    const MatrixXd x = slopes(from), weighted = weights_of(residual_).asDiagonal() * x;
    const MatrixXd information = x.transpose() * weighted;
    const VectorXd score = weighted.transpose() * residual_;
    std::vector<Index> all(static_cast<std::size_t>(x.cols()));
    std::iota(all.begin(), all.end(), 0);
    for (const double damping : {1e-3, 0.1, 10.0}) {
      Effects tried = moved(effects_, bounded_step(information, score, from, damping, all));
      VectorXd residual = residual_of(tried);
      if (!(loss_of(residual) < loss() - kLeastGain)) continue;
      effects_ = std::move(tried);
      residual_ = std::move(residual);
      return true;
    }
    return false;
  }

  const WhitenedData& data_;
  Effects effects_;
  VectorXd residual_;
};

}  // namespace

std::vector<Effects> strongest_drive_pairs(const WhitenedData& data, const Evaluation& base,
                                           const ProbeSlopes& known, std::size_t count) {
  std::vector<std::pair<double, Effects>> fitted;  // with the loss
  for (const Output output : data.drive().outputs()) {
    std::vector<LinearPair> pairs = linear_pairs_of(regression_of(data, base, known, axis_of(output)));
    pairs.resize(std::min(pairs.size(), kFitted));
    for (LinearPair& pair : pairs) {
      const EquationErrorFit fit(data, std::move(pair.effects));
      fitted.emplace_back(fit.loss(), fit.effects());
    }
  }
  std::ranges::sort(fitted, std::less{}, &std::pair<double, Effects>::first);
  fitted.resize(std::min(count, fitted.size()));
  std::vector<Effects> strongest;
  for (auto& [loss, effects] : fitted) strongest.push_back(std::move(effects));
  return strongest;
}

}  // namespace crane::diagnosis
