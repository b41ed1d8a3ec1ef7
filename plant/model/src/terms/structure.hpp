#pragma once
/// Natural frequency from which the structure terms count as rigid.
#include <numbers>

namespace crane::plant {

/// (2 pi 12 Hz)^2, in (rad/s)^2. Structures with a higher natural frequency count as rigid: a drive commanded
/// at 100 Hz hardly excites them, and integrators with fixed steps of 2.5 ms cannot resolve them.
inline constexpr double kRigid_radps2 = 4 * std::numbers::pi * std::numbers::pi * 12 * 12;

}  // namespace crane::plant
