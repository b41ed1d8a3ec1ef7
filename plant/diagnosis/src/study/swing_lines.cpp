#include "study/swing_lines.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace crane::diagnosis {
namespace {

constexpr double kWindow_s = 12;  // ten periods of a cable of 0.36 m: resolves 1.5 times a frequency
constexpr double kSlowest_hz = 0.15, kFastest_hz = 6;
constexpr double kFaint = 1e-4;  // of the strongest line's power: a hundredth of its amplitude
constexpr double kSkirt = 4;     // half width of a line, 1 / window
constexpr double kTurn = 2 * std::numbers::pi;

/// Power at `hz` of samples without their mean, by the four-term window of F. J. Harris, Proc. IEEE 66 (1978)
/// 51: a weak line stands out beside a strong one, whose side lobes are 92 dB lower.
double power(const std::vector<double>& samples, std::size_t first, std::size_t count, double period_s,
             double hz) {
  double mean = 0;
  for (std::size_t k = 0; k < count; ++k) mean += samples[first + k] / static_cast<double>(count);
  std::complex<double> sum;
  const std::complex<double> step = std::polar(1.0, -kTurn * hz * period_s);
  std::complex<double> turned = 1;
  for (std::size_t k = 0; k < count; ++k, turned *= step) {
    const double phase = kTurn * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    const double window =
        0.35875 - 0.48829 * std::cos(phase) + 0.14128 * std::cos(2 * phase) - 0.01168 * std::cos(3 * phase);
    sum += window * (samples[first + k] - mean) * turned;
  }
  return std::norm(sum);
}

}  // namespace

std::vector<double> swing_lines(const std::vector<PreparedRun>& runs, std::size_t count) {
  double longest_s = 0;
  for (const PreparedRun& run : runs) longest_s = std::max(longest_s, run.run.duration_s());
  const double window_s = std::min(kWindow_s, longest_s);
  if (!(window_s > 0)) return {};
  const double resolution_hz = 1 / window_s, step_hz = resolution_hz / 4;
  std::vector<double> powers(static_cast<std::size_t>((kFastest_hz - kSlowest_hz) / step_hz) + 1);
  for (const PreparedRun& run : runs)
    for (const Output output : {kRadialSwing, kTangentialSwing}) {
      if (!run.run.has(output)) continue;
      const std::vector<double>& samples = run.on_grid[output];
      const auto rows = std::min(samples.size(), static_cast<std::size_t>(window_s / run.run.period_s));
      for (std::size_t first = 0; rows > 0 && first + rows <= samples.size(); first += (rows + 1) / 2)
        for (std::size_t i = 0; i < powers.size(); ++i)
          powers[i] +=
              power(samples, first, rows, run.run.period_s, kSlowest_hz + step_hz * static_cast<double>(i));
    }
  std::vector<std::size_t> peaks;
  for (std::size_t i = 1; i + 1 < powers.size(); ++i)
    if (powers[i] > powers[i - 1] && powers[i] >= powers[i + 1]) peaks.push_back(i);
  std::ranges::sort(peaks, [&](std::size_t a, std::size_t b) { return powers[a] > powers[b]; });
  std::vector<double> lines;
  for (const std::size_t peak : peaks) {
    const double hz = kSlowest_hz + step_hz * static_cast<double>(peak);
    if (lines.size() < count &&
        std::ranges::all_of(lines, [&](double line) { return std::abs(line - hz) > kSkirt * resolution_hz; }))
      lines.push_back(hz);
  }
  return lines;
}

std::array<TwoCables, 2> cables_with(double slow_hz, double fast_hz, double share_of_most,
                                     double gravity_mps2) {
  // w^4 - S w^2 + P = 0 with S = g (a + l) / ((1 - mu) a l), P = g^2 / ((1 - mu) a l): sum and product of a,
  // l
  const double slow = std::pow(kTurn * slow_hz, 2), fast = std::pow(kTurn * fast_hz, 2);
  const double sum_m = gravity_mps2 * (slow + fast) / (slow * fast);
  const double most = 1 - 4 * slow * fast / std::pow(slow + fast, 2);
  const double share = share_of_most * most;
  const double product_m2 = gravity_mps2 * gravity_mps2 / ((1 - share) * slow * fast);
  const double longer = sum_m / 2 + std::sqrt(std::max(0.0, sum_m * sum_m / 4 - product_m2));
  const double shorter = product_m2 / longer;
  return {{{share, longer, shorter}, {share, shorter, longer}}};
}

}  // namespace crane::diagnosis
