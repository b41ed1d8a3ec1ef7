#pragma once
/// Rigs that the identification cannot distinguish from its estimate.
#include <cstdint>
#include <vector>

#include "tuning/identified.hpp"

namespace crane::tuning {

/// Number of drawn rigs: a law that fails to settle on 14 % of the possible rigs settles on all 20 drawn rigs
/// with a probability of only 5 % (0.86^20).
inline constexpr std::size_t kDrawnRigs = 20;

/// Draws each identified value from a normal distribution with its standard error, independently of the other
/// values. Bounds of the model apply: friction and delay are at least 0; cable, load mass, gain and the
/// values of the second mode are at least half of their estimate. The control loop keeps the estimate; the
/// swing encoders of a drawn rig therefore show a rest angle that the bridge subtracts only in part.
/// @param tuned  with_identified()
[[nodiscard]] std::vector<configuration::Rig> drawn_rigs(const configuration::Rig& tuned,
                                                         const Identified& identified, std::size_t count,
                                                         std::uint64_t seed);

}  // namespace crane::tuning
