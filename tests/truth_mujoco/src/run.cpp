#include "run.hpp"

#include <algorithm>

#include "controller.hpp"
#include "sensors.hpp"

namespace mujoco_truth {
namespace {

/// Largest swing of a valid run; beyond it the load is thrown.
constexpr double kMostSwing_rad = 0.9;
constexpr double kGrid_s = 0.002;

Pose start_of(const Rig& rig, const RunPlan& plan) {
  Pose pose;
  for (std::size_t i = 0; i < kAxes; ++i)
    if (rig.drive[i].there) pose.position[i] = (rig.drive[i].low_m + rig.drive[i].high_m) / 2;
  Chance chance(plan.seed, "start");
  const double direction = rig.tangential      ? chance.uniform(0, 6.28)
                           : chance.sign() > 0 ? 0
                                               : 3.141592653589793;
  pose.swing = {plan.swing_rad * std::cos(direction),
                rig.tangential ? plan.swing_rad * std::sin(direction) : 0};
  return pose;
}

bool in_range(const Rig& rig, const Pose& pose) {
  for (std::size_t i = 0; i < kAxes; ++i)
    if (rig.drive[i].there &&
        (pose.position[i] < rig.drive[i].low_m || pose.position[i] > rig.drive[i].high_m))
      return false;
  return std::abs(pose.swing[0]) < kMostSwing_rad && std::abs(pose.swing[1]) < kMostSwing_rad;
}

}  // namespace

Coloured::Coloured(Chance& chance, double duration_s, double correlation_s) {
  const double keep = std::exp(-kGrid_s / correlation_s), fresh = std::sqrt(1 - keep * keep);
  double value = chance.normal();
  for (double t = 0; t < duration_s + 1; t += kGrid_s) {
    values_.push_back(value);
    value = keep * value + fresh * chance.normal();
  }
}

double Coloured::at(double time_s) const {
  const double place = std::clamp(time_s / kGrid_s, 0.0, static_cast<double>(values_.size() - 2));
  const auto i = static_cast<std::size_t>(place);
  const double s = place - static_cast<double>(i);
  return (1 - s) * values_[i] + s * values_[i + 1];
}

const char* name_of(Experiment experiment) {
  return std::array{"moves", "sines", "sweep", "steps", "free_swing"}[static_cast<std::size_t>(experiment)];
}

std::optional<Run> recorded(const Physics& physics_in, const Nuisance& nuisance, const RunPlan& plan) {
  Physics physics = physics_in;
  physics.rig.cable_m = plan.cable_m;
  const Rig& rig = physics.rig;

  std::array<Coloured, 4> noise;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    Chance chance(plan.seed, "disturbance " + std::to_string(i));
    noise[i] = Coloured(chance, plan.duration_s, nuisance.correlation_s);
  }
  Disturbance disturbance;
  disturbance.load_n = [&](double t) {
    return std::array{nuisance.disturbance_n * noise[0].at(t),
                      rig.tangential ? nuisance.disturbance_n * noise[1].at(t) : 0};
  };
  disturbance.drive_v = [&](double t) {
    return std::array{nuisance.drive_disturbance_v * noise[2].at(t),
                      nuisance.drive_disturbance_v * noise[3].at(t)};
  };

  Chance rows(plan.seed, "rows"), sensing(plan.seed, "noise");
  Crane crane(physics);
  Sensors sensors(physics, nuisance.noise_counts, sensing);
  Driver driver(rig, nuisance, plan);
  Run run;
  run.plan = plan;
  crane.start(start_of(rig, plan));
  sensors.see(0, crane.pose());
  const auto see = [&](double t, const Pose& pose) { sensors.see(t, pose); };
  for (std::size_t k = 0;; ++k) {
    const double late = k == 0 ? 0 : 0.5 * nuisance.jitter * rows.uniform(-1, 1);
    const double at = std::round((static_cast<double>(k) + late) / nuisance.rate_hz * 1e6) / 1e6;
    if (at > plan.duration_s) break;
    crane.advance(at, disturbance, see);
    if (!in_range(rig, crane.pose())) return std::nullopt;
    const auto [position, swing] = sensors.measured();
    Row row{at, {}, position, swing};
    row.command_v = driver.command(row);
    crane.command(row.command_v);
    if (rows.uniform(0, 1) < nuisance.dropped && k > 0) continue;
    run.rows.push_back(row);
    run.poses.push_back(crane.pose());
  }
  return run;
}

}  // namespace mujoco_truth
