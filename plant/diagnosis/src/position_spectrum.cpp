#include "position_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace crane::diagnosis {
namespace {

constexpr double kSlowest = 0.02;  // m/s or rad/s: below it, friction's reversals hide what position does

struct Samples {
  std::vector<double> position, acceleration;
};

/// What the drive does beyond the model, sample by sample (equation error): rough, but enough for a period.
Samples unexplained_acceleration(const runtime::Rig& rig, const std::vector<PreparedRun>& runs, Output axis) {
  Samples samples;
  plant::Model model(rig.plant, rig.terms, rig.period_s);
  for (const PreparedRun& run : runs) {
    const Motion& motion = run.motion[axis];
    if (motion.position.empty()) continue;
    const Motion fine = smooth(run.run.measured[axis], run.run.period_s, 2);
    for (std::size_t k = 1; k + 1 < run.run.rows(); ++k) {
      if (std::abs(motion.rate[k]) < kSlowest) continue;
      plant::State state;
      const auto of = [&](Output o, const std::vector<double> Motion::*what) {
        return run.motion[o].position.empty() ? 0.0 : (run.motion[o].*what)[k];
      };
      state.trolley_m = of(kTrolleyPosition, &Motion::position),
      state.trolley_mps = of(kTrolleyPosition, &Motion::rate);
      state.slew_rad = of(kSlewAngle, &Motion::position), state.slew_radps = of(kSlewAngle, &Motion::rate);
      state.radial_rad = of(kRadialSwing, &Motion::position),
      state.radial_radps = of(kRadialSwing, &Motion::rate);
      state.tangential_rad = of(kTangentialSwing, &Motion::position);
      state.tangential_radps = of(kTangentialSwing, &Motion::rate);
      state.cable_m = run.run.cable_m[k];
      plant::Actuation actuation;
      for (std::size_t i = 0; i < 2; ++i)
        actuation.drive_v[i] = 0.5 * (run.run.command_v[k - 1][i] + run.run.command_v[k][i]);
      const plant::Accelerations a = model.accelerations(state, actuation);
      samples.position.push_back(fine.position[k]);
      samples.acceleration.push_back(fine.acceleration[k] -
                                     (axis == kTrolleyPosition ? a.trolley_mps2 : a.slew_radps2));
    }
  }
  return samples;
}

}  // namespace

std::vector<PositionWave> strongest_waves(const runtime::Rig& rig, const std::vector<PreparedRun>& runs,
                                          Output axis, std::size_t count) {
  Samples samples = unexplained_acceleration(rig, runs, axis);
  const std::size_t n = samples.position.size();
  if (n < 200) return {};
  const auto [low, high] = std::minmax_element(samples.position.begin(), samples.position.end());
  const double travel = *high - *low;
  if (!(travel > 0)) return {};
  double mean = 0;
  for (const double a : samples.acceleration) mean += a / static_cast<double>(n);
  // A few slips would drown the rest.
  std::vector<double> sizes;
  for (double& a : samples.acceleration) a -= mean, sizes.push_back(std::abs(a));
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(n * 9 / 10), sizes.end());
  const double limit = sizes[n * 9 / 10];
  for (double& a : samples.acceleration) a = std::clamp(a, -limit, limit);

  constexpr int kLines = 400;  // a quarter of a line of the travelled distance apart
  constexpr double kSpacing = 0.25;
  std::vector<std::complex<double>> lines(kLines);
  std::vector<double> power(kLines);
  std::vector<std::complex<double>> turn(n), at(n, 1.0);
  for (std::size_t k = 0; k < n; ++k)
    turn[k] = std::polar(1.0, 2 * std::numbers::pi * kSpacing * samples.position[k] / travel);
  for (int line = 0; line < kLines; ++line) {
    std::complex<double> sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += samples.acceleration[k] * at[k], at[k] *= turn[k];
    lines[static_cast<std::size_t>(line)] = 2.0 / static_cast<double>(n) * sum;
    power[static_cast<std::size_t>(line)] = std::norm(sum);
  }
  constexpr std::size_t kFirst =
      20;  // five waves over the travel; longer ones are friction that depends on position
  std::vector<std::size_t> peaks;
  for (std::size_t line = kFirst; line + 1 < power.size(); ++line)
    if (power[line] >= power[line - 1] && power[line] >= power[line + 1]) peaks.push_back(line);
  std::sort(peaks.begin(), peaks.end(), [&](std::size_t a, std::size_t b) { return power[a] > power[b]; });
  std::vector<PositionWave> waves;
  for (std::size_t i = 0; i < std::min(count, peaks.size()); ++i) {
    // a sin(x + psi) = a sin(psi) cos(x) + a cos(psi) sin(x)
    const std::complex<double> line = lines[peaks[i]];
    waves.push_back({travel / (kSpacing * static_cast<double>(peaks[i])), std::abs(line),
                     std::atan2(line.real(), line.imag())});
  }
  return waves;
}

}  // namespace crane::diagnosis
