#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "candidates/screen.hpp"
#include "crane/innovations/rules.hpp"

namespace crane::innovations {
namespace {

constexpr std::size_t kAtOnce = 48;  // wave numbers of one pass of the filter

std::vector<double> wave_numbers(double travel, bool friction) {
  std::vector<double> k;
  const double step = 0.35 / travel, low = (friction ? 1.0 : 1.5) / travel,
               high = (friction ? 12 : 120) / travel;
  for (double at = low; at < high; at += step) k.push_back(at);
  return k;
}

}  // namespace

Whitened whitened(const Problem& problem, const Hypothesis& at, const Columns& columns) {
  std::vector<Innovations> runs(problem.runs.size());
  tbb::parallel_for(std::size_t{0}, runs.size(),
                    [&](std::size_t r) { runs[r] = innovations(problem, at, r, &columns); });
  Eigen::Index rows = 0;
  for (const Innovations& run : runs) rows += run.sensitivity.rows();
  Whitened w{Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(columns.coordinate.size())),
             Eigen::VectorXd::Zero(rows)};
  Eigen::Index begin = 0;
  const double nu = rule::kStudent.value;
  for (const Innovations& run : runs) {
    for (Eigen::Index k = 0; k < run.sensitivity.rows(); ++k) {
      const auto slot = static_cast<std::size_t>(k);
      if (run.log_likelihood[slot] == 0) continue;
      const double z = run.e[slot] / std::sqrt(run.variance[slot]),
                   weight = std::sqrt((nu + 1) / (nu + z * z));
      w.y[begin + k] = weight * z;
      w.x.row(begin + k) = weight * run.sensitivity.row(k);
    }
    begin += run.sensitivity.rows();
  }
  return w;
}

Wave strongest_wave(const Problem& problem, const Hypothesis& at, std::size_t drive, bool friction) {
  const auto numbers = wave_numbers(problem.scales.travel[drive], friction);
  const std::size_t coordinate = drive == 0 ? kX : kGamma;
  const std::size_t q = problem.layout(at.values).begin[coordinate];
  const double rest = rule::kRestBand.value * rule::kRestSpeed.value * problem.scales.speed[drive];
  Wave best;
  for (std::size_t from = 0; from < numbers.size(); from += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, numbers.size() - from);
    Columns columns;
    columns.coordinate.assign(2 * count + 1, coordinate);
    columns.evaluate = [&, count, from](double, const double* s, const std::array<double, 2>&, double* h) {
      const double sign = friction ? std::tanh(s[q + 1] / rest) : 1;
      for (std::size_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * numbers[from + i] * s[q];
        h[2 * i] = std::cos(angle) * sign, h[2 * i + 1] = std::sin(angle) * sign;
      }
      h[2 * count] = sign;
    };
    const Whitened w = whitened(problem, at, columns);
    const Eigen::MatrixXd gram = w.x.transpose() * w.x;
    const Eigen::VectorXd right = w.x.transpose() * w.y;
    const auto mean = static_cast<Eigen::Index>(2 * count);
    const double mean_alone = 0.5 * right[mean] * right[mean] / (gram(mean, mean) + 1e-9);
    for (std::size_t i = 0; i < count; ++i) {
      const std::array<Eigen::Index, 3> places{static_cast<Eigen::Index>(2 * i),
                                               static_cast<Eigen::Index>(2 * i) + 1, mean};
      Eigen::Matrix3d h;
      Eigen::Vector3d g;
      for (Eigen::Index a = 0; a < 3; ++a) {
        g[a] = right[places[static_cast<std::size_t>(a)]];
        for (Eigen::Index b = 0; b < 3; ++b)
          h(a, b) = gram(places[static_cast<std::size_t>(a)], places[static_cast<std::size_t>(b)]);
        h(a, a) += 1e-9;
      }
      // The innovation is measured - predicted: sensitivities of e to a force are negative of those of the
      // prediction.
      const Eigen::Vector3d amount = h.ldlt().solve(g);
      const double gain = 0.5 * g.dot(amount) - mean_alone;
      if (gain > best.gain) best = {gain, 1 / numbers[from + i], amount[0], amount[1]};
    }
  }
  return best;
}

}  // namespace crane::innovations
