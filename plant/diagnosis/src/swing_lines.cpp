#include "swing_lines.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <sstream>

#include "parallel.hpp"
#include "robust.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Lines half a width apart in a run of 40 s.
constexpr double kLowest_hz = 0.1, kHighest_hz = 4, kSpacing_hz = 0.0125;
constexpr std::size_t kLineFolds = 4;
constexpr std::size_t kLineFlips = 99;
/// Share of the swing's loss: a smaller line is of no consequence for the crane.
constexpr double kLineShare = 0.012;

/// A force with one frequency on one output, seen through every window: cosine and sine of a run's own phase.
struct Line {
  double hz = 0;
  std::vector<Vector2d> pull;
  std::vector<Matrix2d> curvature;
};

/// Once free motion is taken out, a pendulum's response to a force is the force times a constant.
Line line_at(const Problem& load, const Fits& fits, std::size_t output, double hz) {
  Line line{hz, {}, {}};
  const double omega = 2 * std::numbers::pi * hz;
  for (std::size_t w = 0; w < fits.size(); ++w) {
    const Window& window = load.windows()[w];
    const double turn = omega * load.runs()[window.run].run.period_s;
    const auto rows = static_cast<Index>(window.rows), first = static_cast<Index>(output) * rows;
    MatrixXd waves(rows, 2);
    for (Index k = 0; k < rows; ++k) {
      const double phase = turn * static_cast<double>(static_cast<Index>(window.first) + k);
      waves(k, 0) = std::cos(phase), waves(k, 1) = std::sin(phase);
    }
    load.whitener(output, w).apply(waves);
    const MatrixXd basis = fits[w].basis.middleRows(first, rows);
    waves -= basis * (basis.transpose() * waves).eval();
    const VectorXd residual = fits[w].residual.segment(first, rows);
    line.pull.emplace_back(waves.transpose() * weights_of(residual).cwiseProduct(residual));
    line.curvature.emplace_back(waves.transpose() * waves);
  }
  return line;
}

/// Sums over the windows of one run, in or out of a fold.
struct Sums {
  Vector2d pull = Vector2d::Zero();
  Matrix2d curvature = Matrix2d::Zero();
};
using ByRun = std::map<std::size_t, Sums>;

ByRun summed(const Problem& load, const Line& line, const VectorXd& signs, std::size_t fold, bool inside) {
  ByRun sums;
  for (std::size_t w = 0; w < line.pull.size(); ++w) {
    if ((w % kLineFolds == fold) != inside) continue;
    Sums& of_run = sums[load.windows()[w].run];
    of_run.pull += signs[static_cast<Index>(w)] * line.pull[w];
    of_run.curvature += line.curvature[w];
  }
  return sums;
}

Vector2d amplitude(const Sums& sums) {
  const Matrix2d regular = sums.curvature + (1e-9 * sums.curvature.trace() + 1e-12) * Matrix2d::Identity();
  return regular.inverse() * sums.pull;
}

/// The best line, each fold predicted by the others: frequency and amplitude.
struct Found {
  double gain = 0, hz = 0;
};
Found cross_validated(const Problem& load, const std::vector<Line>& lines, const VectorXd& signs) {
  Found found;
  for (std::size_t fold = 0; fold < kLineFolds; ++fold) {
    const Line* best = nullptr;
    double most = 0;
    for (const Line& line : lines) {
      double gain = 0;
      for (const auto& [run, sums] : summed(load, line, signs, fold, false))
        gain += sums.pull.dot(amplitude(sums));
      if (gain > most) most = gain, best = &line;
    }
    if (best == nullptr) continue;
    const ByRun others = summed(load, *best, signs, fold, false);
    for (const auto& [run, own] : summed(load, *best, signs, fold, true)) {
      const auto known = others.find(run);
      if (known == others.end()) continue;
      const Vector2d x = amplitude(known->second);
      found.gain += 2 * x.dot(own.pull) - x.dot(own.curvature * x);
    }
    found.hz = best->hz;
  }
  return found;
}

/// The most that windows with signs at random give.
double by_luck(const Problem& load, const std::vector<Line>& lines, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<VectorXd> signs(kLineFlips, VectorXd::Ones(static_cast<Index>(load.windows().size())));
  for (VectorXd& flip : signs)
    for (double& sign : flip) sign = (random() & 1U) != 0U ? 1.0 : -1.0;
  std::vector<double> gains(kLineFlips);
  parallel_for(kLineFlips, [&](std::size_t i) { gains[i] = cross_validated(load, lines, signs[i]).gain; });
  return *std::max_element(gains.begin(), gains.end());
}

}  // namespace

std::vector<Unexplained> find_swing_lines(const Problem& load, const Fits& fits, std::uint64_t seed) {
  std::vector<Unexplained> all;
  double loss = 0;
  for (const WindowFit& fit : fits) loss += loss_of(fit.residual);
  for (std::size_t output = 0; output < load.outputs().size() && !fits.empty(); ++output) {
    const auto count = static_cast<std::size_t>((kHighest_hz - kLowest_hz) / kSpacing_hz);
    std::vector<Line> lines(count);
    parallel_for(count, [&](std::size_t i) {
      lines[i] = line_at(load, fits, output, kLowest_hz + kSpacing_hz * static_cast<double>(i));
    });
    const Found found = cross_validated(load, lines, VectorXd::Ones(static_cast<Index>(fits.size())));
    if (found.gain < kLineShare * loss || found.gain <= by_luck(load, lines, seed)) continue;
    std::ostringstream name;
    name.precision(3);
    name << kOutputNames[load.outputs()[output]] << ": time, " << found.hz << " Hz";
    all.push_back({name.str(), found.gain, found.gain / loss, true});
  }
  return all;
}

}  // namespace crane::diagnosis
