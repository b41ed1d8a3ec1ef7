#pragma once
/// Search over a grid of trolley and slew at one cable length.
#include <optional>
#include <vector>

#include "crane/control/way.hpp"
#include "leg.hpp"

namespace crane::control {

/// A* from `from` to `to`, which have the same cable length.
/// @param blocking  gets, per zone, whether it bounds the space that the search has reached
/// @return the nodes of the fastest way over the grid, with both ends; nothing: no way
[[nodiscard]] std::optional<std::vector<plant::PerAxis>> search_grid(const WaySpace& space,
                                                                     const plant::PerAxis& from,
                                                                     const plant::PerAxis& to,
                                                                     std::vector<char>& blocking);

/// Leg from the start or to the target: the rule of a straight move, which may leave the margin of a zone.
[[nodiscard]] Leg end_leg(const WaySpace& space, const plant::PerAxis& from, const plant::PerAxis& to);

}  // namespace crane::control
