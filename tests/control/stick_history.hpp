#pragma once
/// Random histories of a stick.
#include <array>
#include <random>

#include "crane/control/stick.hpp"

namespace crane::control::test {

/// Limits of deploy/rigs/virginia_tech_tower.toml.
/// @param used  axes of the session
inline StickLimits tower_stick(Shaping shaping = Shaping::zv,
                               const std::array<bool, kAxes>& used = {true, true, true}) {
  StickLimits limits;
  limits.axis = {{{0.4982, 0.9929, 0.24, 1.86}, {1.0435, 2.0796, -3.0, 3.0}, {0.2, 0.5, 0.4, 1.5}}};
  limits.shaping = shaping;
  for (std::size_t i = 0; i < kAxes; ++i)
    if (!used[i] && !(i == kTrolley && used[kSlew])) limits.axis[i].speed = 0;
  limits.longest_cable_m = used[kHoist] ? 1.5 : 1.0;
  return limits;
}

/// Holds a deflection of each axis for a random time, then chooses another deflection: full, zero, or in
/// between.
class RandomStick {
 public:
  RandomStick(unsigned seed, std::array<bool, kAxes> used, double longest_hold_s)
      : random_{seed}, used_{used}, longest_hold_s_{longest_hold_s} {}

  /// Fractions of the reference speeds at the next tick.
  std::array<double, kAxes> next(double period_s) {
    for (std::size_t i = 0; i < kAxes; ++i) {
      left_s_[i] -= period_s;
      if (!used_[i] || left_s_[i] > 0) continue;
      left_s_[i] = longest_hold_s_ * share_(random_);
      const double kind = share_(random_);
      deflection_[i] = kind < 0.3 ? 1 : kind < 0.6 ? -1 : kind < 0.75 ? 0 : 2 * share_(random_) - 1;
    }
    return deflection_;
  }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> share_{0, 1};
  std::array<bool, kAxes> used_;
  double longest_hold_s_;
  std::array<double, kAxes> deflection_{}, left_s_{};
};

inline std::array<double, kAxes> speeds(const StickLimits& limits, const std::array<double, kAxes>& share) {
  std::array<double, kAxes> wanted{};
  for (std::size_t i = 0; i < kAxes; ++i) wanted[i] = share[i] * limits.axis[i].speed;
  return wanted;
}

}  // namespace crane::control::test
