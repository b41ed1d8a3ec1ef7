#include "data/swapped.hpp"

#include <algorithm>
#include <cmath>

#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {
namespace {

/// A correlation above the first value is clear; below the second value there is no correlation. Probability
/// 1e-6 that 4 s of independent motion, smoothed over 0.1 s, exceed the first value.
constexpr double kClearCorrelation = 0.8, kNoCorrelation = 0.4;
constexpr double kShortestRun_s = 4, kCorrelationSmoothing_s = 0.05;

Motion smoothed(const Run& run, Output output) {
  const int half = std::max(3, static_cast<int>(std::lround(kCorrelationSmoothing_s / run.period_s)));
  return savitzky_golay(measured_on_grid(run, output), run.period_s, half);
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ab = 0, aa = 0, bb = 0, mean_a = 0, mean_b = 0;
  const auto n = static_cast<double>(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) mean_a += a[k] / n, mean_b += b[k] / n;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double x = a[k] - mean_a, y = b[k] - mean_b;
    ab += x * y, aa += x * x, bb += y * y;
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

/// Correlation of r'' + (g / l) r with the acceleration of the drive; 0 if one of them is not measured.
double correlation_with_drive(const Run& run, const configuration::Rig& rig, Output swing, Output drive) {
  if (!run.has(swing) || !run.has(drive)) return 0;
  const Motion load = smoothed(run, swing);
  std::vector<double> specific_force;
  for (std::size_t k = 0; k < run.rows(); ++k)
    specific_force.push_back(load.acceleration[k] +
                             rig.plant.gravity_mps2 / run.cable_m[k] * load.position[k]);
  return correlation(specific_force, smoothed(run, drive).acceleration);
}

}  // namespace

void find_swapped(const std::vector<Run>& runs, const configuration::Rig& rig, Findings& findings) {
  bool swapped = false, turned = false;
  for (const Run& run : runs) {
    if (run.duration_s() < kShortestRun_s) continue;
    const double own = correlation_with_drive(run, rig, kRadialSwing, kTrolleyPosition);
    const double other = correlation_with_drive(run, rig, kTangentialSwing, kTrolleyPosition);
    swapped = swapped || (std::abs(other) > kClearCorrelation && std::abs(own) < kNoCorrelation);
    turned = turned || (own < -kClearCorrelation && std::abs(other) < kNoCorrelation);
  }
  if (swapped)
    findings.problem(std::string{kOutputNames[kRadialSwing]} + ", " + kOutputNames[kTangentialSwing],
                     "the trolley moves the tangential swing and not the radial one", "columns swapped?");
  if (turned)
    findings.problem(kOutputNames[kRadialSwing],
                     "has the wrong sign: the load swings ahead of an accelerating trolley",
                     "positive with the load towards the tower; sign?");
}

}  // namespace crane::diagnosis
