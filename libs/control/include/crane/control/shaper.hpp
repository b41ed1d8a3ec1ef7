#pragma once
/// Input shapers convolve a reference with two or three impulses, whose swings cancel each other. The weights
/// of the impulses add up to one. Swing feedback changes the frequency of the swing: with such a controller,
/// the swing of the shaped motion must be a part of the reference (stick.hpp). Sources: Singer and Seering
/// 1990; Singhose, Seering and Singer 1994. T: assumed load period. f: actual frequency of the swing.
/// r = f T: ratio of actual to assumed frequency. V = 0.05. For an undamped load:
///   name  weights                       times        residual swing / swing of the unshaped reference
///   zv    1/2, 1/2                      0, T/2       |cos(pi r/2)|
///   zvd   1/4, 1/2, 1/4                 0, T/2, T    cos^2(pi r/2)
///   ei    (1+V)/4, (1-V)/2, (1+V)/4     0, T/2, T    |(1+V)/2 cos(pi r) + (1-V)/2|
/// The residual swing of ei is at most V for 0.801 <= r <= 1.199.
#include <array>
#include <cstddef>
#include <span>

#include "crane/control/law.hpp"

namespace crane::control {

enum class Shaping { none, zv, zvd, ei };

struct Impulse {
  double time_s = 0;  ///< >= 0
  double weight = 1;  ///< share of the move, in (0, 1]; the weights of all impulses add up to one
};

/// Impulses in the order of time; the first is at 0. A default-constructed Shaper returns its input.
class Shaper {
 public:
  Shaper() = default;
  /// @param load_period_s  T = 2 pi sqrt(L/g), in (0, 1e6] s
  /// @throws std::invalid_argument for another period
  Shaper(Shaping shaping, double load_period_s);

  [[nodiscard]] std::span<const Impulse> impulses() const noexcept { return {impulses_.data(), count_}; }
  /// Time that the shaper adds to the duration of a move.
  [[nodiscard]] double delay_s() const noexcept { return impulses_[count_ - 1].time_s; }

  /// The shaped profile at `time_s`. It ends delay_s() after the profile, at the same position.
  /// The function allocates no memory.
  /// @tparam Profile  anything with `AxisReference at(double time_s)`
  template <typename Profile>
  [[nodiscard]] AxisReference at(const Profile& profile, double time_s) const noexcept {
    const AxisReference first = profile.at(time_s);
    AxisReference sum = first;  // adding differences keeps a constant profile exact to the last bit
    for (std::size_t i = 1; i < count_; ++i) {
      const AxisReference late = profile.at(time_s - impulses_[i].time_s);
      sum.position += impulses_[i].weight * (late.position - first.position);
      sum.speed += impulses_[i].weight * (late.speed - first.speed);
      sum.acceleration += impulses_[i].weight * (late.acceleration - first.acceleration);
    }
    return sum;
  }

 private:
  std::array<Impulse, 3> impulses_{};
  std::size_t count_ = 1;
};

}  // namespace crane::control
