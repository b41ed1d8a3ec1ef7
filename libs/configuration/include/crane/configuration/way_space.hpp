#pragma once
/// Converts a rig to the input of the search for ways. Supervisor, planner and `crane zone way` use this
/// function, so that all of them search in the same space.
#include "crane/configuration/rig.hpp"
#include "crane/control/way.hpp"

namespace crane::configuration {

[[nodiscard]] control::WaySpace way_space_of(const Rig& rig);

}  // namespace crane::configuration
