#include "search/rough_interval.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A rough loss is looked at in units of such a share of the value.
constexpr double kRoughUnit = 0.03;
constexpr std::array kRoughDistances{1.0, 2.0, 4.0};

/// Numbers of the values of effects whose loss is rough.
std::vector<Index> rough_values(const Effects& effects) {
  std::vector<Index> all;
  Index i = 0;
  for (const Effect& effect : effects)
    for (std::size_t k = 0; k < effect.values.size(); ++k, ++i)
      if (effect.candidate->rough) all.push_back(i);
  return all;
}

/// Places about 0 in which a bowl can be told: along every value and along every two.
std::vector<VectorXd> places_about(Index values) {
  std::vector<VectorXd> places{VectorXd::Zero(values)};
  for (Index i = 0; i < values; ++i) {
    for (const double distance : kRoughDistances)
      for (const double side : {-1.0, 1.0}) places.emplace_back(side * distance * VectorXd::Unit(values, i));
    for (Index j = 0; j < i; ++j)
      for (const double a : {-2.0, 2.0})
        for (const double b : {-2.0, 2.0})
          places.emplace_back(a * VectorXd::Unit(values, i) + b * VectorXd::Unit(values, j));
  }
  return places;
}

}  // namespace

void widen_rough(const Study& study, Fitted& fitted) {
  const std::vector<Index> rough = rough_values(fitted.effects);
  const auto n = static_cast<Index>(rough.size());
  if (n == 0) return;
  VectorXd unit = VectorXd::Zero(fitted.covariance.cols());
  Index i = 0;
  for (const Effect& effect : fitted.effects)
    for (const double value : effect.values) unit[i++] = kRoughUnit * std::abs(value);
  const std::vector<VectorXd> places = places_about(n);
  const auto rows = static_cast<Index>(places.size());
  MatrixXd powers(rows, 1 + n + n * (n + 1) / 2);
  VectorXd losses(rows);
  for (Index row = 0; row < rows; ++row) {
    const VectorXd& place = places[static_cast<std::size_t>(row)];
    VectorXd step = VectorXd::Zero(unit.size());
    for (Index v = 0; v < n; ++v)
      step[rough[static_cast<std::size_t>(v)]] = place[v] * unit[rough[static_cast<std::size_t>(v)]];
    losses[row] = study.train(moved(fitted.effects, step)).loss;
    Index column = 0;
    powers(row, column++) = 1;
    for (Index v = 0; v < n; ++v) powers(row, column++) = place[v];
    for (Index v = 0; v < n; ++v)
      for (Index w = 0; w <= v; ++w) powers(row, column++) = place[v] * place[w];
  }
  const VectorXd bowl = powers.colPivHouseholderQr().solve(losses);
  const double roughness =
      std::sqrt((losses - powers * bowl).squaredNorm() / static_cast<double>(rows - powers.cols()));
  MatrixXd curvature(n, n);
  Index column = 1 + n;
  for (Index v = 0; v < n; ++v)
    for (Index w = 0; w <= v; ++w, ++column)
      curvature(v, w) = curvature(w, v) = (v == w ? 2 : 1) * bowl[column];
  // Not wider than was looked.
  const Eigen::SelfAdjointEigenSolver<MatrixXd> axes(curvature);
  const double flattest = 2 * roughness / std::pow(kRoughDistances.back(), 2);
  const VectorXd wide = 2 * roughness * axes.eigenvalues().cwiseMax(flattest).cwiseInverse();
  const MatrixXd covariance = axes.eigenvectors() * wide.asDiagonal() * axes.eigenvectors().transpose();
  for (Index v = 0; v < n; ++v) {
    const Index at = rough[static_cast<std::size_t>(v)];
    double& own = fitted.std_dev[static_cast<std::size_t>(at)];
    own = std::max(own, unit[at] * std::sqrt(covariance(v, v)));
  }
}

}  // namespace crane::diagnosis
