#pragma once
/// The process of the friction compensation: adds the contributions of both laws and the estimated friction
/// of the drives.
#include "crane/runtime/joined_component.hpp"
#include "crane/runtime/process.hpp"

namespace crane::services {

/// Joins crane/state, crane/tracking and crane/anti_swing; publishes crane/demand and, with [adaptation],
/// crane/adaptation.
[[nodiscard]] runtime::ComponentSpec friction_compensation_spec();

}  // namespace crane::services
