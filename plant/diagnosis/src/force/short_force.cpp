#include "force/short_force.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "data/median.hpp"
#include "force/pendulum_response.hpp"
#include "parallel.hpp"
#include "replay/standstill.hpp"
#include "rules.hpp"
#include "shooting/pieces.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Durations of the pulses. Pulses of one duration begin half a duration apart.
constexpr std::array kPulses_periods{0.25, 1.0};

struct Pulse {
  ShortForce force;
  double statistic = 0;  ///< amplitude / its standard deviation by the noise model
  double permitted = 0;  ///< the same ratio for the permitted amplitude
  bool support_moves = false;
};

/// Accelerations of half a sine of `rows` rows, row x pulse, beginning half a pulse apart.
MatrixXd half_sines(Index all_rows, Index rows, double peak) {
  const Index apart = std::max<Index>(1, rows / 2);
  MatrixXd pulses = MatrixXd::Zero(all_rows, std::max<Index>(0, (all_rows - rows) / apart + 1));
  for (Index pulse = 0; pulse < pulses.cols(); ++pulse)
    for (Index k = 0; k < rows; ++k)
      pulses(pulse * apart + k, pulse) =
          peak * std::sin(std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(rows));
  return pulses;
}

/// Rms of the swings about their means, from half a period before the pulse to half a period after it. An
/// error of the axes of the sensor or of a turning support moves a part of one swing into the other.
double swing_around(const PreparedRun& run, std::size_t first, std::size_t rows, std::size_t half_period) {
  double squares = 0;
  for (const Output swing : simulated_outputs(run, Part::load)) {
    const std::vector<double>& swing_rad = run.on_grid[swing];
    const std::size_t from = first - std::min(first, half_period);
    const std::size_t until = std::min(swing_rad.size(), first + rows + half_period);
    const auto around =
        Eigen::Map<const VectorXd>(&swing_rad[from], static_cast<Index>(until - from)).array();
    squares += (around - around.mean()).square().mean();
  }
  return std::sqrt(squares);
}

bool support_moves(const PreparedRun& run, std::size_t first, std::size_t rows) {
  return std::ranges::any_of(std::array{kTrolleyPosition, kSlewAngle}, [&](Output drive) {
    const std::vector<double>& rate = run.motion[drive].rate;
    for (std::size_t k = first; k < std::min(rate.size(), first + rows); ++k)
      if (std::abs(rate[k]) >= kStandstillSpeed) return true;
    return false;
  });
}

std::vector<Pulse> pulses_in(const Pieces& pieces, const Piece& piece, const WindowMotion& motion,
                             double periods, double permitted) {
  const double load_period_s = 2 * std::numbers::pi / motion.natural_radps;
  const auto rows = static_cast<Index>(std::lround(periods * load_period_s / motion.period_s));
  const auto half_period = static_cast<std::size_t>(0.5 * load_period_s / motion.period_s);
  const auto all_rows = static_cast<Index>(piece.rows);
  if (rows < 1 || rows > all_rows) return {};
  // A constant acceleration of w^2 moves the equilibrium by 1 rad: a force of the weight.
  MatrixXd response = half_sines(all_rows, rows, motion.natural_radps * motion.natural_radps);
  replace_by_pendulum_response(response, motion.natural_radps, motion.period_s);
  response = response_to(pieces, piece, std::move(response));
  const PreparedRun& run = (*pieces.runs)[piece.run];
  std::vector<Pulse> pulses;
  for (Index i = 0; i < response.cols(); ++i) {
    const double norm = response.col(i).norm();  // in standard deviations of the noise, per weight
    if (!(norm > 0)) continue;
    const std::size_t first = piece.first + static_cast<std::size_t>(i) *
                                                std::max<std::size_t>(1, static_cast<std::size_t>(rows / 2));
    const auto length = static_cast<std::size_t>(rows);
    Pulse pulse;
    pulse.statistic = response.col(i).dot(piece.residual) / norm;
    pulse.permitted = permitted * swing_around(run, first, length, half_period) * norm;
    pulse.support_moves = support_moves(run, first, length);
    pulse.force = {pieces.output, piece.run, static_cast<double>(first) * motion.period_s,
                   static_cast<double>(rows) * motion.period_s, pulse.statistic / norm};
    pulses.push_back(pulse);
  }
  return pulses;
}

/// Standard deviation of normal values from the median of their absolute values.
double robust_deviation(const std::vector<double>& values) {
  return values.empty() ? 0 : kNormalPerMedian * median(values);
}

}  // namespace

std::optional<ShortForce> find_short_force(const Problem& problem, const Fits& fits, std::size_t output,
                                           double permitted) {
  const Pieces pieces = pieces_of(problem, fits, output);
  std::optional<ShortForce> found;
  double largest = 0;
  std::size_t tests = 0;
  for (const double periods : kPulses_periods) {
    std::vector<std::vector<Pulse>> of_windows(pieces.all.size());
    parallel_for(of_windows.size(), [&](std::size_t w) {
      of_windows[w] = pulses_in(pieces, pieces.all[w], problem.motion(output, w), periods, permitted);
    });
    std::vector<double> all, moving;
    for (const std::vector<Pulse>& pulses : of_windows)
      for (const Pulse& pulse : pulses) {
        all.push_back(std::abs(pulse.statistic));
        if (pulse.support_moves) moving.push_back(std::abs(pulse.statistic));
      }
    tests += all.size();
    const double usual = robust_deviation(all), in_motion = std::max(usual, robust_deviation(moving));
    for (const std::vector<Pulse>& pulses : of_windows)
      for (const Pulse& pulse : pulses) {
        const double expected = std::hypot(pulse.support_moves ? in_motion : usual, pulse.permitted);
        if (!(std::abs(pulse.statistic) > largest * expected)) continue;
        largest = std::abs(pulse.statistic) / expected;
        found = pulse.force;
      }
  }
  const double p_value =
      std::erfc(largest / std::numbers::sqrt2) * static_cast<double>(tests * problem.outputs().size());
  return p_value <= rules::kSignificant ? found : std::nullopt;
}

}  // namespace crane::diagnosis
