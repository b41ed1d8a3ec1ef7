/// Simulated experiments from which fuzzy_generated derives its rules. Units: load periods and cable lengths.
/// Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003.
#include <cmath>
#include <numbers>

#include "crane/control/delay_line.hpp"
#include "crane/control/fuzzy.hpp"
#include "crane/control/trajectory.hpp"

namespace crane::control {
namespace {

using std::numbers::pi;

constexpr double kStep = 5e-4;   // integration step, load periods
constexpr int kSampleEvery = 2;  // integration steps per sample
constexpr double kDuration = 2;  // duration of an experiment, load periods
// Duration of a transfer, load periods; not in the source. Among the durations from 0.5 to 2, this value
// gives the table nearest to the printed one.
constexpr double kTransfer = 0.75;

/// Integrates (3.27), (3.28) with tracking (3.40) and delayed_1 (3.47) by the semi-implicit Euler method.
void append_response(const Design& design, double swing, double transfer, std::vector<FuzzySample>& samples) {
  constexpr double kA = 4 * pi * pi;  // (3.33) in normalised time
  const AxisProfile profile = timed_profile(0, transfer, kTransfer, kTransfer / 3);
  const double delay_ticks = design.delayed_1_delay / kStep;
  DelayLine past(delay_ticks);
  past.reset(swing);
  double position = 0, speed = 0, rate = 0;
  // With unsuitable gains of delayed_1 the swing can exceed pi; the experiment then ends.
  for (int k = 0; k * kStep < kDuration && std::abs(swing) < pi; ++k) {
    past.push(swing);
    const double late = past.at(delay_ticks);
    if (k % kSampleEvery == 0)
      samples.push_back({swing / design.fuzzy_swing_rad, rate / design.fuzzy_swing_rate,
                         design.delayed_1_gain * late / (design.fuzzy_gain * design.fuzzy_swing_rad)});
    const AxisReference wanted = profile.at(k * kStep);
    const double acceleration = design.tracking_proportional * (wanted.position - position) +
                                design.tracking_derivative * (wanted.speed - speed) +
                                design.delayed_1_gain * late;
    speed += kStep * acceleration;
    position += kStep * speed;
    rate += kStep * (acceleration - kA * swing);
    swing += kStep * rate;
  }
}

}  // namespace

std::vector<FuzzySample> delayed_1_response(const Design& design) {
  std::vector<FuzzySample> samples;
  for (const double direction : {1.0, -1.0}) {
    for (int degrees = 2; degrees <= 30; degrees += 2)
      append_response(design, direction * degrees * pi / 180, 0, samples);
    for (int quarters = 1; quarters <= 6; ++quarters)
      append_response(design, 0, direction * quarters / 4, samples);
  }
  return samples;
}

}  // namespace crane::control
