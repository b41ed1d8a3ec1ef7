#include "data/swapped.hpp"

#include <algorithm>
#include <cmath>

#include "crane/diagnosis/replay.hpp"
#include "crane/plant/pendulum.hpp"

namespace crane::diagnosis {
namespace {

/// A correlation above the first value is clear; below the second value there is no correlation. Probability
/// 1e-6 that 4 s of independent motion, smoothed over 0.1 s, exceed the first value.
constexpr double kClearCorrelation = 0.8, kNoCorrelation = 0.4;
constexpr double kShortestRun_s = 4, kCorrelationSmoothing_s = 0.05;
/// For the tangential swing: half width of the smoothing, in periods of the load; fewest smoothed values that
/// do not overlap.
constexpr double kTangentialSmoothing_periods = 0.05, kFewestIndependent = 25;

Motion smoothed(const Run& run, Output output, double half_width_s) {
  const int half = std::max(3, static_cast<int>(std::lround(half_width_s / run.period_s)));
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

/// r'' + (g / l) r of a swing, by row.
std::vector<double> specific_force(const Run& run, const configuration::Rig& rig, Output swing,
                                   double half_width_s) {
  const Motion load = smoothed(run, swing, half_width_s);
  std::vector<double> force;
  for (std::size_t k = 0; k < run.rows(); ++k)
    force.push_back(load.acceleration[k] + rig.plant.gravity_mps2 / run.cable_m[k] * load.position[k]);
  return force;
}

/// Correlation with the acceleration of the trolley; 0 if one of them is not measured.
double correlation_with_trolley(const Run& run, const configuration::Rig& rig, Output swing) {
  if (!run.has(swing) || !run.has(kTrolleyPosition)) return 0;
  return correlation(specific_force(run, rig, swing, kCorrelationSmoothing_s),
                     smoothed(run, kTrolleyPosition, kCorrelationSmoothing_s).acceleration);
}

/// Correlation of the tangential swing with -(x slew'' + 2 x' slew'), the acceleration of the trolley across
/// the jib with the opposite sign (docs/equations.md, row 4 of (2.17) to (2.20)). 0 if one of them is not
/// measured or the run is too short.
double correlation_with_slew(const Run& run, const configuration::Rig& rig) {
  if (!run.has(kTangentialSwing) || !run.has(kSlewAngle)) return 0;
  const double period_s = plant::swing_period_s(rig.plant.gravity_mps2, rig.start.position[plant::kHoist]);
  const double half_width_s = kTangentialSmoothing_periods * period_s;
  if (run.duration_s() < kFewestIndependent * 2 * half_width_s) return 0;
  const Motion slew = smoothed(run, kSlewAngle, half_width_s);
  Motion trolley;
  if (run.has(kTrolleyPosition)) trolley = smoothed(run, kTrolleyPosition, half_width_s);
  std::vector<double> across;
  for (std::size_t k = 0; k < run.rows(); ++k) {
    const bool measured = !trolley.position.empty();
    const double x = measured ? trolley.position[k] : rig.start.position[plant::kTrolley];
    across.push_back(-(x * slew.acceleration[k] + (measured ? 2 * trolley.rate[k] * slew.rate[k] : 0)));
  }
  return correlation(specific_force(run, rig, kTangentialSwing, half_width_s), across);
}

}  // namespace

void find_swapped(const std::vector<Run>& runs, const configuration::Rig& rig, Findings& findings) {
  bool swapped = false, turned = false, turned_across = false;
  for (const Run& run : runs) {
    if (run.duration_s() < kShortestRun_s) continue;
    const double own = correlation_with_trolley(run, rig, kRadialSwing);
    const double other = correlation_with_trolley(run, rig, kTangentialSwing);
    swapped = swapped || (std::abs(other) > kClearCorrelation && std::abs(own) < kNoCorrelation);
    turned_across = turned_across || correlation_with_slew(run, rig) < -kClearCorrelation;
    turned = turned || (own < -kClearCorrelation && std::abs(other) < kNoCorrelation);
  }
  if (swapped)
    findings.problem(std::string{kOutputNames[kRadialSwing]} + ", " + kOutputNames[kTangentialSwing],
                     "the tangential swing follows the trolley, the radial swing does not",
                     "exchange the two columns");
  if (turned)
    findings.problem(kOutputNames[kRadialSwing],
                     "has the wrong sign: the load swings ahead of an accelerating trolley",
                     "must be positive with the load towards the tower: change the sign in the mapping");
  if (turned_across)
    findings.problem(kOutputNames[kTangentialSwing],
                     "has the wrong sign: the load swings ahead of an accelerating jib",
                     "must be positive with the load ahead in the direction of a positive slew angle: change "
                     "the sign in the mapping");
}

}  // namespace crane::diagnosis
