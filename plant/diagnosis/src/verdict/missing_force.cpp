#include "verdict/missing_force.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "rules.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {
namespace {

/// Rms of a signal whose mean square contains that of independent noise.
double root_without(double mean_square, double of_noise) {
  return std::sqrt(std::max(0.0, mean_square - of_noise));
}

}  // namespace

double rms_motion(const Problem& problem, std::size_t output) {
  double squares = 0, count = 0;
  for (const Window& window : problem.windows()) {
    const Eigen::VectorXd measured = problem.measured_values(window, output);
    squares += (measured.array() - measured.mean()).matrix().squaredNorm();
    count += static_cast<double>(measured.size());
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

double measured_noise(const Problem& problem, std::size_t output) {
  constexpr double kMedianOfNormal = 0.6745, kSquaredWeights = 20;  // 1 + 9 + 9 + 1
  std::vector<double> differences;
  for (const Window& window : problem.windows()) {
    const Run& run = problem.runs()[window.run].run;
    const std::vector<double>& measured = run.measured[problem.outputs()[output]];
    for (std::size_t k = window.first + 3; k < window.first + window.rows; ++k) {
      bool all = true;
      for (std::size_t i = 0; i <= 3; ++i) all = all && run.is_measured(problem.outputs()[output], k - i);
      if (all)
        differences.push_back(
            std::abs(measured[k] - 3 * measured[k - 1] + 3 * measured[k - 2] - measured[k - 3]));
    }
  }
  if (differences.empty()) return 0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return *middle / (kMedianOfNormal * std::sqrt(kSquaredWeights));
}

double share_not_followed(const Problem& problem, const Fits& fits, std::size_t output, double noise) {
  const double motion = root_without(std::pow(rms_motion(problem, output), 2), noise * noise);
  if (motion <= rules::kLeastSwingRms) return 0;
  double count = 0;
  for (const Window& window : problem.windows())
    count += static_cast<double>(problem.measured_rows(window, output));
  return root_without(sum(problem.squares_left(fits, output)) / count, noise * noise) / motion;
}

double missing_force(const Problem& problem, const Fits& fits, std::size_t output, double natural_radps,
                     double noise) {
  constexpr double kSpan_periods = 1.0 / 8;
  double squares = 0, count = 0, by_noise = 0;
  for (std::size_t w = 0; w < fits.size(); ++w) {
    const Window& window = problem.windows()[w];
    const double period_s = problem.runs()[window.run].run.period_s;
    const auto rows = static_cast<Eigen::Index>(window.rows);
    const auto span = static_cast<Eigen::Index>(
        std::lround(kSpan_periods * 2 * std::numbers::pi / natural_radps / period_s));
    if (span < 1 || rows <= 2 * span) continue;
    const Eigen::VectorXd left = (problem.measured(window) - fits[w].simulated)
                                     .segment(static_cast<Eigen::Index>(output) * rows, rows);
    const double scale = 1 / std::pow(static_cast<double>(span) * period_s * natural_radps, 2);
    const Run& run = problem.runs()[window.run].run;
    const auto is_measured = [&](Eigen::Index k) {
      return run.is_measured(problem.outputs()[output], window.first + static_cast<std::size_t>(k));
    };
    const double of_white_noise = 2 * scale * scale + std::pow(1 - 2 * scale, 2);
    for (Eigen::Index k = span; k + span < rows; ++k) {
      if (!is_measured(k - span) || !is_measured(k) || !is_measured(k + span)) continue;
      const double force = scale * (left[k + span] - 2 * left[k] + left[k - span]) + left[k];
      squares += force * force;
      by_noise += of_white_noise * noise * noise;
      ++count;
    }
  }
  return count > 0 ? root_without(squares / count, by_noise / count) : 0;
}

}  // namespace crane::diagnosis
