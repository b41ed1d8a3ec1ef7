#pragma once
/// The load as a small-angle pendulum of length L.
#include <cmath>
#include <numbers>

namespace crane::plant {

/// w0 = sqrt(g/L)
[[nodiscard]] inline double swing_radps(double gravity_mps2, double cable_m) noexcept {
  return std::sqrt(gravity_mps2 / cable_m);
}

/// T = 2 pi sqrt(L/g)
[[nodiscard]] inline double swing_period_s(double gravity_mps2, double cable_m) noexcept {
  return 2 * std::numbers::pi * std::sqrt(cable_m / gravity_mps2);
}

}  // namespace crane::plant
