#pragma once
/// Search over a grid of trolley and slew at one cable length.
#include <optional>
#include <vector>

#include "crane/control/path.hpp"
#include "leg.hpp"

namespace crane::control {

/// A* from `from` to `to`, which have the same cable length.
/// @param blocking  by zone, receives 1 for each zone that bounds the space that the search has reached
/// @return the positions of the fastest path over the grid, with both ends; nothing: no path
[[nodiscard]] std::optional<std::vector<PerAxis>> search_grid(const PathSpace& space, const PerAxis& from,
                                                              const PerAxis& to, std::vector<char>& blocking);

/// First or last leg of a path: its least clearance is kRestClearance_m, and it may begin below this
/// clearance if it increases the clearance.
[[nodiscard]] Leg end_leg(const PathSpace& space, const PerAxis& from, const PerAxis& to);

}  // namespace crane::control
