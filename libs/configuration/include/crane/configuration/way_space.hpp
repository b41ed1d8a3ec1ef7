#pragma once
/// The rig file as the search for ways sees it. Supervisor, planner and `crane zone way` use this function,
/// so that they search in the same space.
#include "crane/configuration/rig.hpp"
#include "crane/control/way.hpp"

namespace crane::configuration {

[[nodiscard]] control::WaySpace way_space_of(const Rig& rig);

}  // namespace crane::configuration
