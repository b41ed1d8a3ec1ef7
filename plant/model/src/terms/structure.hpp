#pragma once
/// What the structure terms share.
#include <numbers>

namespace crane::plant {

/// Squared angular frequency of 12 Hz: structures stiffer than this are taken as rigid, because a drive at
/// 100 Hz hardly excites them and fixed-step integrators of 2.5 ms cannot follow.
inline constexpr double kRigid_radps2 = 4 * std::numbers::pi * std::numbers::pi * 12 * 12;

}  // namespace crane::plant
