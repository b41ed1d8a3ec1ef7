#include "sensors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mujoco_truth {

Sensors::Sensors(const Physics& physics, double noise_counts, Chance& chance)
    : physics_(physics), noise_counts_(noise_counts), chance_(chance) {}

void Sensors::see(double time_s, const Pose& pose) {
  Past now{time_s, pose.swing, {}};
  if (history_.empty()) {
    first_ = pose;
  } else {
    const Past& before = history_.back();
    for (std::size_t i = 0; i < kSwings; ++i)
      now.integral[i] = before.integral[i] + (time_s - before.time_s) * (before.swing[i] + now.swing[i]) / 2;
    for (std::size_t i = 0; i < kAxes; ++i) way_[i] += std::abs(pose.position[i] - pose_.position[i]);
  }
  pose_ = pose;
  history_.push_back(now);
  const double keep = physics_.sensor.swing_delay_s + physics_.sensor.swing_mean_s + 0.01;
  while (history_.size() > 2 && history_[1].time_s < time_s - keep) history_.pop_front();
}

Sensors::Past Sensors::past(double time_s) const {
  const auto after = std::lower_bound(history_.begin(), history_.end(), time_s,
                                      [](const Past& past, double t) { return past.time_s < t; });
  if (after == history_.begin()) {  // before the start, the load has the position of the start
    Past first = history_.front();
    for (std::size_t i = 0; i < kSwings; ++i) first.integral[i] -= (first.time_s - time_s) * first.swing[i];
    return first;
  }
  if (after == history_.end()) return history_.back();
  const Past &b = *after, &a = *(after - 1);
  const double s = (time_s - a.time_s) / (b.time_s - a.time_s);
  Past between{time_s, {}, {}};
  for (std::size_t i = 0; i < kSwings; ++i) {
    between.swing[i] = a.swing[i] + s * (b.swing[i] - a.swing[i]);
    between.integral[i] = a.integral[i] + s * (b.integral[i] - a.integral[i]);
  }
  return between;
}

Sensors::Values Sensors::measured() {
  const SensorFault& fault = physics_.sensor;
  Values values;
  const double at = history_.back().time_s - fault.swing_delay_s;
  std::array<double, kSwings> swing = past(at).swing;
  if (fault.swing_mean_s > 0) {
    const Past a = past(at - fault.swing_mean_s), b = past(at);
    for (std::size_t i = 0; i < kSwings; ++i) swing[i] = (b.integral[i] - a.integral[i]) / fault.swing_mean_s;
  }
  const double c = std::cos(fault.misalignment_rad), s = std::sin(fault.misalignment_rad);
  swing = {swing[0] * c + swing[1] * s, swing[1] * c - swing[0] * s};
  const auto counted = [&](double value, double counts) {
    if (counts <= 0) return value;
    return std::round(value * counts + noise_counts_ * chance_.normal()) / counts;
  };
  for (std::size_t i = 0; i < kSwings; ++i) {
    const double seen = (1 + fault.swing_scale_change[i]) * swing[i] + fault.swing_offset_rad[i];
    values.swing[i] = physics_.rig.has_swing(i) ? counted(seen, physics_.rig.swing_counts_per_rad) : 0;
  }
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (!physics_.rig.drive[i].there) continue;
    double drift = fault.drift_rate[i] * way_[i];
    if (fault.drift_jump[i] > 0) drift = std::trunc(drift / fault.drift_jump[i]) * fault.drift_jump[i];
    const double p = pose_.position[i];
    const double seen =
        (1 + fault.position_scale_change[i]) * p + drift +
        fault.eccentricity_m[i] * std::sin(2 * std::numbers::pi * p / fault.eccentricity_period[i]);
    values.position[i] = counted(seen, physics_.rig.drive[i].counts_per_m);
  }
  return values;
}

}  // namespace mujoco_truth
