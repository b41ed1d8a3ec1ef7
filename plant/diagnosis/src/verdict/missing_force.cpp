#include "verdict/missing_force.hpp"

#include <cmath>
#include <numbers>

#include "rules.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {

double rms_motion(const Problem& problem, std::size_t output) {
  double squares = 0, count = 0;
  for (const Window& window : problem.windows()) {
    const Eigen::VectorXd measured = problem.measured_values(window, output);
    squares += (measured.array() - measured.mean()).matrix().squaredNorm();
    count += static_cast<double>(measured.size());
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

double share_not_followed(const Problem& problem, const Fits& fits, std::size_t output) {
  const double motion = rms_motion(problem, output);
  if (motion <= rules::kLeastSwingRms) return 0;
  double count = 0;
  for (const Window& window : problem.windows())
    count += static_cast<double>(problem.measured_rows(window, output));
  return std::sqrt(sum(problem.squares_left(fits, output)) / count) / motion;
}

double missing_force(const Problem& problem, const Fits& fits, std::size_t output, double natural_radps) {
  constexpr double kSpan_periods = 1.0 / 8;
  double squares = 0, count = 0;
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
    for (Eigen::Index k = span; k + span < rows; ++k) {
      if (!is_measured(k - span) || !is_measured(k) || !is_measured(k + span)) continue;
      const double force = scale * (left[k + span] - 2 * left[k] + left[k - span]) + left[k];
      squares += force * force;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

}  // namespace crane::diagnosis
