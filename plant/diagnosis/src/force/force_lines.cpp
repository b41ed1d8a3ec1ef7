#include "force/force_lines.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <sstream>

#include "force/force_response.hpp"
#include "parallel.hpp"
#include "robust.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Lines half a width apart in a run of 40 s.
constexpr double kLowest_hz = 0.1, kHighest_hz = 4, kSpacing_hz = 0.0125;
constexpr std::size_t kLineFolds = 4;
constexpr std::size_t kLineFlips = 99;
/// Share of the loss of drives or load: a smaller line is of no consequence for the crane.
constexpr double kLineOfDrives = 0.004, kLineOfLoad = 0.012;

/// A force with one frequency on one output, seen through every window: cosine and sine of a run's own phase.
struct Line {
  double hz = 0;
  std::vector<Explained> windows;
};

Line line_at(const Problem& problem, const Fits& fits, std::size_t output, double hz) {
  Line line{hz, {}};
  const double omega = 2 * std::numbers::pi * hz;
  for (std::size_t w = 0; w < fits.size(); ++w) {
    const Window& window = problem.windows()[w];
    const double turn = omega * problem.runs()[window.run].run.period_s;
    MatrixXd waves(static_cast<Index>(window.rows), 2);
    for (Index k = 0; k < waves.rows(); ++k) {
      const double phase = turn * static_cast<double>(static_cast<Index>(window.first) + k);
      waves(k, 0) = std::cos(phase), waves(k, 1) = std::sin(phase);
    }
    line.windows.push_back(explained(problem, fits, w, output, std::move(waves)));
  }
  return line;
}

/// Sums over the windows of one run, in or out of a fold.
using ByRun = std::map<std::size_t, Explained>;

ByRun summed(const Problem& problem, const Line& line, const VectorXd& signs, std::size_t fold, bool inside) {
  ByRun sums;
  for (std::size_t w = 0; w < line.windows.size(); ++w) {
    if ((w % kLineFolds == fold) != inside) continue;
    auto [of_run, fresh] =
        sums.try_emplace(problem.windows()[w].run, Explained{VectorXd::Zero(2), MatrixXd::Zero(2, 2)});
    of_run->second.pull += signs[static_cast<Index>(w)] * line.windows[w].pull;
    of_run->second.curvature += line.windows[w].curvature;
  }
  return sums;
}

/// The best line, each fold predicted by the others: frequency and amplitude.
struct Found {
  double gain = 0, hz = 0;
};
Found cross_validated(const Problem& problem, const std::vector<Line>& lines, const VectorXd& signs) {
  Found found;
  for (std::size_t fold = 0; fold < kLineFolds; ++fold) {
    const Line* best = nullptr;
    double most = 0;
    for (const Line& line : lines) {
      double gain = 0;
      for (const auto& [run, sums] : summed(problem, line, signs, fold, false))
        gain += sums.pull.dot(wave_amplitude(sums));
      if (gain > most) most = gain, best = &line;
    }
    if (best == nullptr) continue;
    const ByRun others = summed(problem, *best, signs, fold, false);
    for (const auto& [run, own] : summed(problem, *best, signs, fold, true)) {
      const auto known = others.find(run);
      if (known == others.end()) continue;
      const Vector2d x = wave_amplitude(known->second);
      found.gain += own.gain(x);
    }
    found.hz = best->hz;
  }
  return found;
}

/// The most that windows with signs at random give.
double by_luck(const Problem& problem, const std::vector<Line>& lines, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<VectorXd> signs(kLineFlips, VectorXd::Ones(static_cast<Index>(problem.windows().size())));
  for (VectorXd& flip : signs)
    for (double& sign : flip) sign = (random() & 1U) != 0U ? 1.0 : -1.0;
  std::vector<double> gains(kLineFlips);
  parallel_for(kLineFlips, [&](std::size_t i) { gains[i] = cross_validated(problem, lines, signs[i]).gain; });
  return *std::max_element(gains.begin(), gains.end());
}

}  // namespace

std::vector<Unexplained> find_force_lines(const Problem& problem, const Fits& fits, std::uint64_t seed) {
  std::vector<Unexplained> all;
  const double least = problem.part() == Part::drive ? kLineOfDrives : kLineOfLoad;
  double loss = 0;
  for (const WindowFit& fit : fits) loss += loss_of(fit.residual);
  for (std::size_t output = 0; output < problem.outputs().size() && !fits.empty(); ++output) {
    const auto count = static_cast<std::size_t>((kHighest_hz - kLowest_hz) / kSpacing_hz);
    std::vector<Line> lines(count);
    parallel_for(count, [&](std::size_t i) {
      lines[i] = line_at(problem, fits, output, kLowest_hz + kSpacing_hz * static_cast<double>(i));
    });
    const Found found = cross_validated(problem, lines, VectorXd::Ones(static_cast<Index>(fits.size())));
    if (found.gain < least * loss || found.gain <= by_luck(problem, lines, seed)) continue;
    std::ostringstream name;
    name.precision(3);
    name << kOutputNames[problem.outputs()[output]] << ": time, " << found.hz << " Hz";
    all.push_back({name.str(), found.gain, found.gain / loss, problem.part() == Part::load});
  }
  return all;
}

}  // namespace crane::diagnosis
