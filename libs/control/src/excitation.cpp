#include "crane/control/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crane::control {
namespace {

/// A value with its first and second derivative with respect to time.
struct Jet {
  double value = 0, first = 0, second = 0;
};

/// 3 s^2 - 2 s^3 with s = time / rise: from rest at 0 to rest at 1.
Jet rise(double time_s, double rise_s) noexcept {
  const double s = time_s / rise_s;
  if (s <= 0) return {};
  if (s >= 1) return {1, 0, 0};
  return {s * s * (3 - 2 * s), 6 * s * (1 - s) / rise_s, 6 * (1 - 2 * s) / (rise_s * rise_s)};
}

Jet sum_of(const std::array<Sine, 4>& sines, double time_s) noexcept {
  Jet sum;
  for (const Sine& sine : sines) {
    const double rate = 2 * std::numbers::pi * sine.frequency_hz;
    const double angle = rate * time_s + sine.phase_rad;
    sum.value += sine.amplitude * std::sin(angle);
    sum.first += sine.amplitude * rate * std::cos(angle);
    sum.second -= sine.amplitude * rate * rate * std::sin(angle);
  }
  return sum;
}

}  // namespace

AxisReference Excitation::at(double time_s) const noexcept {
  if (!(time_s > 0) || time_s >= duration_s) return {mean_position, 0, 0};
  const double fade_s = std::min(kFade_s, duration_s / 2);
  const double left_s = duration_s - time_s;
  Jet fade = rise(time_s, fade_s);
  if (left_s < fade_s) {
    fade = rise(left_s, fade_s);
    fade.first = -fade.first;
  }
  const Jet sum = sum_of(sines, time_s);
  return {.position = mean_position + fade.value * sum.value,
          .speed = fade.first * sum.value + fade.value * sum.first,
          .acceleration = fade.second * sum.value + 2 * fade.first * sum.first + fade.value * sum.second};
}

}  // namespace crane::control
