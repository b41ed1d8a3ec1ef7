#pragma once
/// A reference that excites one axis for identification: a position plus a sum of sines, (4.11), (4.14).
/// Source: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003.
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
  double mean_position = 0;     ///< mean position: m, rad, m of cable
  std::array<Sine, 4> sines{};  ///< amplitude 0: unused
  double duration_s = 0;        ///< >= 0

  /// The reference starts and ends at rest at `mean_position`. The sines fade in and out over kFade_s each,
  /// at most over half the duration. With duration 0 or without sines the reference is a step to
  /// `mean_position`. No allocation.
  [[nodiscard]] AxisReference at(double time_s) const noexcept;

  static constexpr double kFade_s = 3;
};

}  // namespace crane::control
