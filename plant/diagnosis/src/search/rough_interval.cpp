#include "search/rough_interval.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "replay/travel.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Distance between evaluations of a rough loss: share of a value; angle of a wave.
constexpr double kRoughUnit = 0.03, kRoughUnit_rad = 0.03;
/// The distance is at least this share of the finite-difference step of the value.
constexpr double kLeastUnit = 0.1;
constexpr std::array kRoughDistances{1.0, 2.0, 4.0};
/// If the standard deviation is below kResolvedDistances times the distance, the distance is halved and the
/// loss is evaluated again, at most kClosest times.
constexpr double kResolvedDistances = 0.5;
constexpr int kClosest = 4;

/// True if the loss has steps: impacts of a gap or slips of a drive come one row earlier or later.
bool is_rough(const Candidate& candidate) { return candidate.rough || (candidate.drive && !candidate.load); }

/// Directions of a wave: amplitude, phase, and a period that shifts the wave at the ends of the travel but
/// not in the middle.
MatrixXd directions_of_wave(const Effect& wave, const Extent& travel) {
  const double amplitude = wave.values[0], period = wave.values[2];
  const double of_period = kRoughUnit_rad * period * period / (std::numbers::pi * travel.width());
  MatrixXd directions = MatrixXd::Zero(3, 3);
  directions(0, 0) = kRoughUnit * amplitude;
  directions(1, 1) = kRoughUnit_rad;
  directions(1, 2) = 2 * std::numbers::pi * travel.middle() / (period * period) * of_period;
  directions(2, 2) = of_period;
  return directions;
}

/// Directions of the values of an effect, one column per direction. The distance never exceeds kRoughUnit of
/// the distance from the value of no effect (an offset of 0, a gain of 1).
MatrixXd directions_of(const Effect& effect, const Runs& runs) {
  const Candidate& candidate = *effect.candidate;
  if (candidate.waves) return directions_of_wave(effect, travel_of(runs, candidate.drive_output()));
  VectorXd units(static_cast<Index>(effect.values.size()));
  for (std::size_t i = 0; i < effect.values.size(); ++i) {
    const double value = effect.values[i], null = candidate.parameters[i].null;
    units[static_cast<Index>(i)] = std::max(kRoughUnit * std::min(std::abs(value), std::abs(value - null)),
                                            kLeastUnit * candidate.parameters[i].step);
  }
  return units.asDiagonal();
}

/// Points around 0 that determine a parabola: along each direction and along each pair of directions.
std::vector<VectorXd> places_about(Index directions) {
  std::vector<VectorXd> places{VectorXd::Zero(directions)};
  for (Index i = 0; i < directions; ++i) {
    for (const double distance : kRoughDistances)
      for (const double side : {-1.0, 1.0})
        places.emplace_back(side * distance * VectorXd::Unit(directions, i));
    for (Index j = 0; j < i; ++j)
      for (const double a : {-2.0, 2.0})
        for (const double b : {-2.0, 2.0})
          places.emplace_back(a * VectorXd::Unit(directions, i) + b * VectorXd::Unit(directions, j));
  }
  return places;
}

/// Covariance of the region in which the fitted parabola rises by less than the roughness of the losses.
MatrixXd covariance_of(const std::vector<VectorXd>& places, const VectorXd& losses) {
  const Index n = places[0].size();
  MatrixXd powers(losses.size(), 1 + n + n * (n + 1) / 2);
  for (Index row = 0; row < losses.size(); ++row) {
    const VectorXd& place = places[static_cast<std::size_t>(row)];
    Index column = 0;
    powers(row, column++) = 1;
    for (Index v = 0; v < n; ++v) powers(row, column++) = place[v];
    for (Index v = 0; v < n; ++v)
      for (Index w = 0; w <= v; ++w) powers(row, column++) = place[v] * place[w];
  }
  const VectorXd quadratic = powers.colPivHouseholderQr().solve(losses);
  const double freedom = static_cast<double>(losses.size() - powers.cols());
  const double roughness = std::sqrt((losses - powers * quadratic).squaredNorm() / freedom);
  MatrixXd curvature(n, n);
  Index column = 1 + n;
  for (Index v = 0; v < n; ++v)
    for (Index w = 0; w <= v; ++w, ++column)
      curvature(v, w) = curvature(w, v) = (v == w ? 2 : 1) * quadratic[column];
  // The region does not extend beyond the evaluated points.
  const Eigen::SelfAdjointEigenSolver<MatrixXd> axes(curvature);
  const double flattest = std::max(2 * roughness / std::pow(kRoughDistances.back(), 2), 1e-12);
  const VectorXd wide = 2 * roughness * axes.eigenvalues().cwiseMax(flattest).cwiseInverse();
  return axes.eigenvectors() * wide.asDiagonal() * axes.eigenvectors().transpose();
}

/// Losses around the values of one effect of a fit.
class Surroundings {
 public:
  /// @param first number of the effect's first value among all of the fit
  Surroundings(const WhitenedData& data, const Evaluation& base, const Fitted& fitted, const Effect& effect,
               Index first)
      : data_(data),
        base_(base),
        fitted_(fitted),
        first_(first),
        directions_(directions_of(effect, data.runs())),
        places_(places_about(directions_.cols())) {}

  /// Standard deviations of the values of the effect. Halves the distances while the loss is not a parabola
  /// over them.
  VectorXd std_dev(LossParabola& found) {
    for (int closer = 0;; ++closer, directions_ *= 0.5) {
      const MatrixXd covariance = covariance_of(places_, losses(found));
      if (covariance.diagonal().maxCoeff() > kResolvedDistances * kResolvedDistances || closer == kClosest)
        return (directions_ * covariance * directions_.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
    }
  }

 private:
  VectorXd losses(LossParabola& found) {
    VectorXd all(static_cast<Index>(places_.size()));
    for (std::size_t i = 0; i < places_.size(); ++i) {
      VectorXd step = VectorXd::Zero(static_cast<Index>(fitted_.parameters));
      step.segment(first_, directions_.rows()) = directions_ * places_[i];
      const Effects there = moved(fitted_.effects, step);
      const double loss = data_.evaluated(there, base_).loss;
      all[static_cast<Index>(i)] = loss;
      if (loss < found.best_loss) found.best = there, found.best_loss = loss;
    }
    return all;
  }

  const WhitenedData& data_;
  const Evaluation& base_;
  const Fitted& fitted_;
  Index first_;
  MatrixXd directions_;
  std::vector<VectorXd> places_;
};

}  // namespace

LossParabola fit_loss_parabola(const WhitenedData& data, const Evaluation& base, const Fitted& fitted) {
  LossParabola found{VectorXd::Zero(static_cast<Index>(fitted.parameters)), fitted.effects,
                     fitted.train.loss};
  Index first = 0;
  for (const Effect& effect : fitted.effects) {
    const auto count = static_cast<Index>(effect.values.size());
    if (is_rough(*effect.candidate))
      found.std_dev.segment(first, count) = Surroundings(data, base, fitted, effect, first).std_dev(found);
    first += count;
  }
  return found;
}

}  // namespace crane::diagnosis
