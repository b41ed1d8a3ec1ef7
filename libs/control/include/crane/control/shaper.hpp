#pragma once
/// Input shapers: a reference convolved with two or three impulses that sum up to one, so that the swings
/// they excite cancel. They work on a reference that the axis follows as it stands (tracking alone); a law
/// that damps the swing by feedback changes the frequency they are made for.
///   zv   1/2, 1/2                      at 0, T/2       no swing left at the load's own frequency
///   zvd  1/4, 1/2, 1/4                 at 0, T/2, T    and none for small errors of the frequency
///   ei   (1+V)/4, (1-V)/2, (1+V)/4     at 0, T/2, T    V = 5 % left there, at most 5 % over +-20 %
/// for a load without damping (Singer and Seering 1990; Singhose, Seering and Singer 1994). Off the frequency
/// they are made for, r = f T, they leave |cos(pi r/2)|, cos^2(pi r/2) and |(1+V)/2 cos(pi r) + (1-V)/2| of
/// the swing that the unshaped reference makes.
#include <array>
#include <cstddef>

#include "crane/control/law.hpp"

namespace crane::control {

enum class Shaping { none, zv, zvd, ei };

struct Impulse {
  double time_s = 0;  ///< >= 0
  double share = 1;   ///< of the move; all shares sum up to one
};

/// Impulses in the order of their time, the first at 0; passes its input when made by default.
class Shaper {
 public:
  Shaper() = default;
  /// @param load_period_s  T = 2 pi sqrt(L/g), in (0, 1e6] s
  /// @throws std::invalid_argument for another period
  Shaper(Shaping shaping, double load_period_s);

  /// What shaping adds to the length of a move.
  [[nodiscard]] double delay_s() const noexcept { return impulses_[count_ - 1].time_s; }

  /// The shaped profile at `time_s`. No allocation; rests where the profile rests, delay_s() later.
  /// @tparam Profile  anything with `AxisReference at(double time_s)`
  template <typename Profile>
  [[nodiscard]] AxisReference at(const Profile& profile, double time_s) const noexcept {
    const AxisReference first = profile.at(time_s);
    AxisReference sum =
        first;  // the shares sum up to one, so that what is equal stays as it is to the last bit
    for (std::size_t i = 1; i < count_; ++i) {
      const AxisReference late = profile.at(time_s - impulses_[i].time_s);
      sum.position += impulses_[i].share * (late.position - first.position);
      sum.speed += impulses_[i].share * (late.speed - first.speed);
      sum.acceleration += impulses_[i].share * (late.acceleration - first.acceleration);
    }
    return sum;
  }

 private:
  std::array<Impulse, 3> impulses_{};
  std::size_t count_ = 1;
};

}  // namespace crane::control
