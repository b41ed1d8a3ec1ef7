#include "crane/identification/excitation_design.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "run_checks.hpp"

namespace crane::identification {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

void check(const ExcitationLimits& limits) {
  require_positive("high - low", limits.high - limits.low);
  require_positive("speed", limits.speed);
}

void scale(control::Excitation& excitation, double factor) {
  for (control::Sine& sine : excitation.sines) sine.amplitude *= factor;
}

}  // namespace

double predicted_swing_rad(const control::Excitation& excitation, const CarriedLoad& load) {
  // Much shorter than any load period, so that semi-implicit Euler conserves the energy.
  constexpr double kStep_s = 0.002;
  const auto suspension = [&](double time_s) {
    const double at = excitation.at(time_s).position;
    return load.radius_m ? *load.radius_m * std::polar(1.0, at) : std::complex<double>{at, 0};
  };
  std::complex<double> position = suspension(0), speed = 0;
  double largest_m = 0;
  const auto steps = static_cast<int>(excitation.duration_s / kStep_s);
  for (int i = 0; i < steps; ++i) {
    const std::complex<double> ahead = position - suspension(i * kStep_s);
    largest_m = std::max(largest_m, std::abs(ahead));
    speed -= kStep_s * load.gravity_mps2 / load.cable_m * ahead;
    position += kStep_s * speed;
  }
  return largest_m / load.cable_m;
}

control::Excitation multi_sine(std::size_t axis, double amplitude, const ExcitationLimits& limits,
                               double duration_s) {
  check(limits);
  require_positive("amplitude", amplitude);
  require_positive("duration_s", duration_s);
  control::Excitation excitation;
  excitation.axis = axis;
  excitation.mean_position = (limits.low + limits.high) / 2;
  excitation.duration_s = duration_s;
  excitation.sines[0] = {-0.4 * amplitude, 1.0 / 3, 0};
  excitation.sines[1] = {0.3 * amplitude, 1.0 / 4, 0};
  double distance = 0, speed = 0;
  for (const control::Sine& sine : excitation.sines) {
    distance += std::abs(sine.amplitude);
    speed += std::abs(sine.amplitude) * kTwoPi * sine.frequency_hz;
  }
  scale(excitation, std::min({1.0, (limits.high - limits.low) / 2 / distance, limits.speed / speed}));
  if (limits.load.cable_m > 0) {
    require_positive("swing_rad", limits.swing_rad);
    constexpr double kReduction = 0.95;
    while (predicted_swing_rad(excitation, limits.load) > limits.swing_rad) scale(excitation, kReduction);
  }
  return excitation;
}

control::Excitation break_away_sine(std::size_t axis, const ExcitationLimits& limits, double stiffness_vpu,
                                    double ramp_vps, double friction_v, int repetitions) {
  check(limits);
  require_positive("stiffness_vpu", stiffness_vpu);
  require_positive("ramp_vps", ramp_vps);
  require_positive("friction_v", friction_v);
  require_positive("repetitions", repetitions);
  // From one end of the sine to the other the voltage changes by twice the friction of both directions.
  constexpr double kSurplus = 2;
  const double needed = friction_v / stiffness_vpu;
  const double amplitude = std::min(kSurplus * needed / 2, (limits.high - limits.low) / 2);
  if (2 * amplitude < 1.2 * needed)
    throw std::invalid_argument("the travel of " + text(limits.high - limits.low) +
                                " is too short to overcome " + text(friction_v) + " V with " +
                                text(stiffness_vpu) + " V per m or rad");
  control::Excitation excitation;
  excitation.axis = axis;
  excitation.mean_position = (limits.low + limits.high) / 2;
  excitation.sines[0] = {amplitude, ramp_vps / stiffness_vpu / (amplitude * kTwoPi), 0};
  excitation.duration_s = repetitions / excitation.sines[0].frequency_hz;
  return excitation;
}

}  // namespace crane::identification
