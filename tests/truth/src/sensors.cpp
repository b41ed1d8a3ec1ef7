/// Sensors of the crane.
#include <algorithm>
#include <cmath>

#include "crane.hpp"

namespace truth {
namespace {

constexpr double kSlipsPerSecond = 2;
constexpr double kHistory_s = 0.6;

}  // namespace

void Crane::slip() {
  for (std::size_t i = 0; i < kDrives; ++i) {
    const double lost = physics_.drive[i].slip_per_s / kSlipsPerSecond * slips_.uniform(0.5, 1.5);
    if (slips_.uniform() < kSlipsPerSecond * kTick_s) slipped_[i] += lost;
  }
}

void Crane::remember() {
  if (physics_.swing_delay_s <= 0 && physics_.swing_average_s <= 0) return;
  past_.push_back({time_s_, now_.q[kRadial], now_.q[kTangential]});
  if (past_.size() > 20000)
    past_.erase(past_.begin(), std::lower_bound(past_.begin(), past_.end(), time_s_ - kHistory_s,
                                                [](const Past& p, double t) { return p.time_s < t; }));
}

std::array<double, 2> Crane::swing_at(double time_s) const {
  if (past_.empty()) return {now_.q[kRadial], now_.q[kTangential]};
  const auto next = std::lower_bound(past_.begin(), past_.end(), time_s,
                                     [](const Past& p, double t) { return p.time_s < t; });
  if (next == past_.begin()) return {next->radial_rad, next->tangential_rad};
  if (next == past_.end()) return {past_.back().radial_rad, past_.back().tangential_rad};
  const Past& before = *(next - 1);
  const double share = (time_s - before.time_s) / (next->time_s - before.time_s);
  return {along(share, before.radial_rad, next->radial_rad),
          along(share, before.tangential_rad, next->tangential_rad)};
}

Sensed Crane::sense() const {
  std::array<double, 2> swing{};
  if (physics_.swing_average_s > 0) {
    const int samples = std::max(1, static_cast<int>(std::lround(physics_.swing_average_s / 0.001)));
    for (int i = 0; i < samples; ++i) {
      const auto one = swing_at(time_s_ - physics_.swing_delay_s - 0.001 * (i + 0.5));
      for (std::size_t k = 0; k < 2; ++k) swing[k] += one[k] / samples;
    }
  } else {
    swing = swing_at(time_s_ - physics_.swing_delay_s);
  }
  if (physics_.swing_misalignment_rad != 0) {  // the direction of the cable in the sensor's turned frame
    const double c = std::cos(physics_.swing_misalignment_rad), s = std::sin(physics_.swing_misalignment_rad);
    const double ux = -std::cos(swing[1]) * std::sin(swing[0]), uy = std::sin(swing[1]);
    const double down = std::cos(swing[1]) * std::cos(swing[0]);
    swing = {std::atan2(-(c * ux + s * uy), down), std::asin(std::clamp(c * uy - s * ux, -1.0, 1.0))};
  }
  Sensed sensed{};
  sensed[0] = physics_.drive[0].encoder_scale * now_.q[kMotorX] + slipped_[0];
  sensed[1] = physics_.drive[1].encoder_scale * now_.q[kMotorSlew] + slipped_[1];
  for (std::size_t i = 0; i < 2; ++i)
    sensed[2 + i] = physics_.swing_scale[i] * swing[i] + physics_.swing_offset_rad[i];
  return sensed;
}

Sensed Crane::measure() {
  Sensed sensed = sense();
  const Sensed counts{physics_.trolley_counts_pm, physics_.slew_counts_prad, physics_.swing_counts_prad,
                      physics_.swing_counts_prad};
  for (std::size_t i = 0; i < sensed.size(); ++i) {
    const double noise = disturbance_.noise_counts * noise_.normal();
    if (counts[i] <= 0) continue;
    const double raw = sensed[i] * counts[i] + noise;
    sensed[i] = (disturbance_.quantised ? std::round(raw) : raw) / counts[i] + 0.0;  // avoids -0
  }
  return sensed;
}

}  // namespace truth
