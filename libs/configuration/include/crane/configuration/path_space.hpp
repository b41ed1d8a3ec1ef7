#pragma once
/// Converts a rig to the input of the search for paths: supervisor, planner and `crane zone path` search in
/// the same space.
#include "crane/configuration/rig.hpp"
#include "crane/control/path.hpp"

namespace crane::configuration {

[[nodiscard]] control::PathSpace path_space_of(const Rig& rig);

}  // namespace crane::configuration
