#include "tuning/excursion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <deque>

#include "crane/plant/coordinates.hpp"

namespace crane::tuning {
namespace {

/// The reference of a scenario, one entry per step of the simulation.
struct Plan {
  std::vector<control::AxisReference> reference;
  double middle = 0, step_s = 0;
};

Plan plan_of(const experiment::Scenario& scenario, double step_s) {
  Plan plan{
      .reference = {}, .middle = scenario.excitations.front().reference.mean_position, .step_s = step_s};
  const auto steps = static_cast<std::size_t>(scenario.end_s() / step_s);
  std::size_t next = 0;
  control::AxisReference rest{.position = plan.middle, .speed = 0, .acceleration = 0};
  for (std::size_t i = 0; i < steps; ++i) {
    const double time_s = static_cast<double>(i) * step_s;
    while (next < scenario.excitations.size() && scenario.excitations[next].at_s <= time_s) ++next;
    plan.reference.push_back(next == 0 ? rest
                                       : scenario.excitations[next - 1].reference.at(
                                             time_s - scenario.excitations[next - 1].at_s));
  }
  return plan;
}

struct PossibleCrane {
  double cable_m = 1, friction_v = 0, gain = 1, reaction = 0;
  std::size_t delay_steps = 0;
};

struct AxisModel {
  double stiffness_vpu = 0, volt_limit_v = 0, gravity_mps2 = 9.81;
  std::optional<double> radius_m;  ///< slew: trolley position

  [[nodiscard]] std::complex<double> suspension(double x) const {
    return radius_m ? *radius_m * std::polar(1.0, x) : std::complex<double>{x, 0};
  }
  /// Distance from the load to the suspension point, along the axis, m.
  [[nodiscard]] double along(std::complex<double> ahead, double x) const {
    return radius_m ? (ahead * std::polar(1.0, -x)).imag() : ahead.real();
  }
};

/// Semi-implicit Euler; Coulomb friction stops the axis and never reverses it.
Excursion excursion_of(const AxisModel& axis, const PossibleCrane& crane, const Plan& plan) {
  Excursion found;
  double x = plan.middle, speed = 0;
  std::complex<double> load = axis.suspension(x), load_speed = 0;
  std::deque<double> volts(crane.delay_steps + 1, 0.0);
  for (const auto& reference : plan.reference) {
    const std::complex<double> ahead = axis.suspension(x) - load;
    volts.push_back(std::clamp(
        axis.stiffness_vpu * (reference.position - x + 2 / kLoop_radps * (reference.speed - speed)),
        -axis.volt_limit_v, axis.volt_limit_v));
    const double reaction = crane.reaction * axis.gravity_mps2 * axis.along(ahead, x) / crane.cable_m;
    const double driven = speed + plan.step_s * (crane.gain * volts.front() - reaction);
    const double friction = plan.step_s * crane.gain * crane.friction_v;
    volts.pop_front();
    speed = std::copysign(std::max(0.0, std::abs(driven) - friction), driven);
    x += plan.step_s * speed;
    load_speed += plan.step_s * axis.gravity_mps2 / crane.cable_m * ahead;
    load += plan.step_s * load_speed;
    found.swing_rad = std::max(found.swing_rad, std::abs(ahead) / crane.cable_m);
    found.distance = std::max(found.distance, std::abs(x - plan.middle));
    found.speed = std::max(found.speed, std::abs(speed));
  }
  return found;
}

/// @return `count` values from low to high, with constant ratio (`ratio` true) or constant difference
std::vector<double> between(double low, double high, int count, bool ratio) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    const double share = i / (count - 1.0);
    values.push_back(ratio ? low * std::pow(high / low, share) : low + share * (high - low));
  }
  return values;
}

/// Trolley: load mass / trolley inertia. Slew: load mass * radius / inertia of jib and trolley. The load mass
/// is that of the rig file.
double load_ratio(const configuration::Rig& rig, std::size_t axis, double radius_m) {
  if (axis == plant::kTrolley) return rig.plant.load_to_trolley_ratio();
  return rig.plant.load_to_jib_ratio() * radius_m /
         (1 + rig.plant.trolley_to_jib_ratio() * radius_m * radius_m);
}

/// Extremes of gain, delay and load mass, combined with several cable lengths and levels of friction, because
/// resonance and stick-slip may be worst between the bounds.
std::vector<PossibleCrane> possible_cranes(const configuration::Rig& careful, const Priors& priors,
                                           const Possible& possible, std::size_t axis, const AxisModel& model,
                                           double step_s) {
  // Neighbouring lengths have a ratio of at most 1.12: their periods differ by at most 6 %.
  const int lengths =
      2 + static_cast<int>(std::log(possible.cable_high_m / possible.cable_low_m) / std::log(1.12));
  const double nominal_gain = kLoop_radps * kLoop_radps / model.stiffness_vpu;
  const double ratio = load_ratio(careful, axis, model.radius_m.value_or(0));
  std::vector<PossibleCrane> cranes;
  for (const double cable_m : between(possible.cable_low_m, possible.cable_high_m, lengths, true))
    for (const double friction_v : between(possible.friction_low_v, possible.friction_high_v, 3, false))
      for (const double share : between((1 - priors.gain_share) / (1 + priors.gain_share), 1, 3, false))
        for (const double mass : {priors.payload_low, priors.payload_high})
          for (const double periods : {1.0, 1 + priors.delay_periods})
            cranes.push_back(
                {.cable_m = cable_m,
                 .friction_v = friction_v,
                 .gain = share * nominal_gain,
                 .reaction = (mass - share * priors.payload_low) * ratio,
                 .delay_steps = static_cast<std::size_t>(std::llround(periods * careful.period_s / step_s))});
  return cranes;
}

}  // namespace

Possible possible_from(const configuration::Rig& rig, const Priors& priors, std::size_t axis) {
  Possible possible{.cable_low_m = priors.cable_low_m,
                    .cable_high_m = priors.cable_high_m,
                    .friction_low_v = 0,
                    .friction_high_v = priors.friction_share * rig.drives[axis].volt_limit_v};
  if (const auto& hoist = rig.drives[plant::kHoist]; hoist.present) {
    possible.cable_low_m = std::max(possible.cable_low_m, hoist.low_limit);
    possible.cable_high_m = std::max(possible.cable_low_m, std::min(possible.cable_high_m, hoist.high_limit));
  }
  return possible;
}

Excursion largest_excursion(const configuration::Rig& careful, const Priors& priors, const Possible& possible,
                            const experiment::Scenario& scenario) {
  const std::size_t axis = scenario.excitations.front().reference.axis;
  AxisModel model{.stiffness_vpu = stiffness_vpu(careful, axis),
                  .volt_limit_v = careful.drives[axis].volt_limit_v,
                  .gravity_mps2 = careful.design.crane.gravity_mps2,
                  .radius_m = {}};
  if (axis == plant::kSlew)
    model.radius_m = scenario.start[plant::kTrolley].value_or(careful.start.position[plant::kTrolley]);
  const auto plan = plan_of(scenario, careful.period_s / 2);
  Excursion largest;
  for (const auto& crane : possible_cranes(careful, priors, possible, axis, model, plan.step_s)) {
    const auto found = excursion_of(model, crane, plan);
    largest.swing_rad = std::max(largest.swing_rad, found.swing_rad);
    largest.distance = std::max(largest.distance, found.distance);
    largest.speed = std::max(largest.speed, found.speed);
  }
  return largest;
}

bool is_safe(const configuration::Rig& careful, const Priors& priors, const Possible& possible,
             const experiment::Scenario& scenario) {
  const std::size_t axis = scenario.excitations.front().reference.axis;
  const auto& drive = careful.drives[axis];
  const auto found = largest_excursion(careful, priors, possible, scenario);
  return found.swing_rad <= kUsedShare * (careful.limits.swing_limit_rad - priors.rest_angle_rad) &&
         found.speed <= kUsedShare * drive.max_speed &&
         found.distance <= kUsedShare * ((drive.high_limit - drive.low_limit) / 2 - drive.soft_margin);
}

}  // namespace crane::tuning
