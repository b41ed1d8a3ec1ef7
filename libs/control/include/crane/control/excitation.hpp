#pragma once
/// A reference that excites one axis, for identification: a sum of sines about a position, as in (4.11),
/// (4.14).
#include <array>
#include <cstddef>

#include "crane/control/law.hpp"

namespace crane::control {

struct Sine {
  double amplitude = 0;  ///< m, rad, m of cable
  double frequency_hz = 0;
  double phase_rad = 0;
};

struct Excitation {
  std::size_t axis = kTrolley;
  double about = 0;  ///< m, rad, m of cable
  std::array<Sine, 4> sines{};
  double duration_s = 0;  ///< >= 0

  /// Begins and ends at rest at `about`: the sum fades in and out over kFade_s each, or half the duration.
  /// A duration of 0, or no sines, is a step to `about`. No allocation.
  [[nodiscard]] AxisReference at(double time_s) const noexcept;

  static constexpr double kFade_s = 3;
};

}  // namespace crane::control
