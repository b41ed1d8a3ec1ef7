#include "tuning/motion.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "crane/identification/excitation_design.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/plant/pendulum.hpp"
#include "tuning/priors.hpp"

namespace crane::tuning {
namespace {

// Swing by the sines / swing limit, when the support follows exactly. Chosen for small angles.
constexpr double kSineShare = 0.35;
// Swing by the first and the second step: step of the support / cable length, rad. The third step is 1.5
// times as large. Chosen: at 0.15 rad, sin x differs from x by 0.4 %.
constexpr double kStepSwing_rad = 0.1;
constexpr double kProbe_s = 6, kProbeRest_s = 3, kSines_s = 30, kRest_s = 2;
constexpr double kProbe_hz = 1.0 / 3;
// Shortest time between steps: 4 time constants of the slowest position loop of the priors. With 0.6 / 1.4 of
// the assumed gain, the poles of kLoop_radps = 7 rad/s have the real part -3 / s.
constexpr double kStepSpacing_s = 1.4;
// Largest error of the rough cable length: number of standard errors plus share of the length. Chosen.
constexpr double kCableErrors = 4, kCableShare = 0.05;

double middle_of(const configuration::Rig& rig, std::size_t axis) {
  return (rig.drives[axis].low_limit + rig.drives[axis].high_limit) / 2;
}
double half_travel(const configuration::Rig& rig, std::size_t axis) {
  const auto& drive = rig.drives[axis];
  return kUsedShare * ((drive.high_limit - drive.low_limit) / 2 - drive.soft_margin);
}

experiment::Scenario in_the_middle(const configuration::Rig& rig, const std::string& name) {
  experiment::Scenario scenario;
  scenario.name = scenario.path = name;
  scenario.description = "motion of crane tune";
  for (const std::size_t i : {plant::kTrolley, plant::kSlew})
    if (rig.drives[i].present) scenario.start[i] = middle_of(rig, i);
  return scenario;
}

/// Returns a scenario for a scale of its amplitudes.
using Scaled = std::function<experiment::Scenario(double)>;

/// @return largest scale <= 1 with a safe motion, with an error of at most kResolution; 0: none
double safe_scale(const configuration::Rig& careful, const Priors& priors, const Possible& possible,
                  const Scaled& scaled) {
  constexpr double kResolution = 1.0 / 64;
  if (is_safe(careful, priors, possible, scaled(1))) return 1;
  double safe = 0, unsafe = 1;
  while (unsafe - safe > kResolution) {
    const double middle = (safe + unsafe) / 2;
    (is_safe(careful, priors, possible, scaled(middle)) ? safe : unsafe) = middle;
  }
  return safe;
}

/// Sines at 0.5 and 0.37 of the frequency of the load: the load follows its support without resonance.
control::Excitation sines(const configuration::Rig& rig, std::size_t axis, double cable_m) {
  const double load_radps = plant::swing_radps(rig.design.crane.gravity_mps2, cable_m);
  const double load_hz = load_radps / (2 * std::numbers::pi);
  control::Excitation excitation;
  excitation.axis = axis;
  excitation.mean_position = middle_of(rig, axis);
  excitation.duration_s = kSines_s;
  excitation.sines[0] = {0.6, 0.5 * load_hz, 0};
  excitation.sines[1] = {0.4, 0.37 * load_hz, 0};
  const double speed = load_radps * (0.6 * 0.5 + 0.4 * 0.37);
  double scale = std::min(half_travel(rig, axis), kUsedShare * rig.drives[axis].max_speed / speed);
  const identification::CarriedLoad load{
      .cable_m = cable_m,
      .gravity_mps2 = rig.design.crane.gravity_mps2,
      .radius_m = axis == plant::kSlew ? std::optional{middle_of(rig, plant::kTrolley)} : std::nullopt};
  const auto scaled = [&](double by) {
    control::Excitation changed = excitation;
    for (auto& sine : changed.sines) sine.amplitude *= by;
    return changed;
  };
  while (identification::predicted_swing_rad(scaled(scale), load) > kSineShare * rig.limits.swing_limit_rad)
    scale *= 0.95;
  return scaled(scale);
}

control::Excitation times(control::Excitation excitation, double scale) {
  for (auto& sine : excitation.sines) sine.amplitude *= scale;
  return excitation;
}

/// Adds three steps away from the middle and back. Each step back follows after a whole number of load
/// periods, so that its swing cancels the swing of the step away.
void add_steps(experiment::Scenario& scenario, std::size_t axis, double middle, double step,
               double spacing_s) {
  double at_s = kMotionBegin_s + kSines_s;
  for (const double target : {1.0, 0.0, -1.0, 0.0, 1.5, 0.0}) {
    control::Excitation excitation;
    excitation.axis = axis;
    excitation.mean_position = middle + target * step;
    scenario.excitations.push_back({at_s, excitation});
    at_s += spacing_s;
  }
  scenario.duration_s = at_s - kMotionBegin_s + kRest_s;
}

}  // namespace

experiment::Scenario probe(const configuration::Rig& careful, const Priors& priors, std::size_t axis,
                           double level, const Possible& possible) {
  auto scenario = in_the_middle(careful, std::string{"probe_"} + plant::kCoordinates[axis].name);
  scenario.duration_s = kProbe_s + kProbeRest_s;
  control::Excitation excitation;
  excitation.axis = axis;
  excitation.mean_position = middle_of(careful, axis);
  excitation.duration_s = kProbe_s;
  const double amplitude = level * careful.drives[axis].volt_limit_v / stiffness_vpu(careful, axis);
  excitation.sines[0] = {std::min(amplitude, half_travel(careful, axis)), kProbe_hz, 0};
  const Scaled scaled = [&](double scale) {
    auto changed = scenario;
    changed.excitations = {{kMotionBegin_s, times(excitation, scale)}};
    return changed;
  };
  return scaled(safe_scale(careful, priors, possible, scaled));
}

configuration::Rig compensated(configuration::Rig careful, std::size_t axis, const Rough& rough) {
  auto& friction = careful.design.friction[axis];
  friction.coulomb_positive_v = friction.coulomb_negative_v = rough.friction_v;
  friction.stiction_positive_v = friction.stiction_negative_v = rough.friction_v;
  friction.factor = 0.5;
  return careful;
}

Possible possible_from(const Rough& rough) {
  const double error_m = std::max(kCableErrors * rough.cable_error_m, kCableShare * rough.cable_m);
  return {.cable_low_m = std::max(rough.cable_m - error_m, rough.cable_m / 2),
          .cable_high_m = rough.cable_m + error_m,
          .friction_low_v = 0,
          .friction_high_v = rough.friction_v};
}

experiment::Scenario main_motion(const configuration::Rig& careful, const Priors& priors, std::size_t axis,
                                 const Rough& rough) {
  auto scenario = in_the_middle(careful, std::string{"main_"} + plant::kCoordinates[axis].name);
  scenario.duration_s = kSines_s;
  const auto possible = possible_from(rough);
  const auto excitation = sines(careful, axis, rough.cable_m);
  const Scaled with_sines = [&](double scale) {
    auto changed = scenario;
    changed.excitations = {{kMotionBegin_s, times(excitation, scale)}};
    return changed;
  };
  scenario = with_sines(safe_scale(careful, priors, possible, with_sines));
  const double arm_m = axis == plant::kTrolley ? 1 : std::max(middle_of(careful, plant::kTrolley), 0.1);
  const double step =
      std::min(kStepSwing_rad * rough.cable_m / arm_m + 0.5 * rough.friction_v / stiffness_vpu(careful, axis),
               half_travel(careful, axis) / 2);
  const double period_s = plant::swing_period_s(careful.design.crane.gravity_mps2, rough.cable_m);
  const double spacing_s = period_s * std::ceil(kStepSpacing_s / period_s);
  const Scaled with_steps = [&](double scale) {
    auto changed = scenario;
    add_steps(changed, axis, middle_of(careful, axis), scale * step, spacing_s);
    return changed;
  };
  return with_steps(safe_scale(careful, priors, possible, with_steps));
}

}  // namespace crane::tuning
