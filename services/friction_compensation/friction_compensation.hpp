#pragma once
/// Friction compensation: adds up the contributions and adds what the drives' friction will take away.
#include "crane/runtime/joined_component.hpp"
#include "crane/runtime/process.hpp"

namespace crane::services {

/// Joins crane/state, crane/tracking and crane/anti_swing; publishes crane/demand.
[[nodiscard]] runtime::ComponentSpec friction_compensation_spec();

}  // namespace crane::services
