#pragma once
/// Anti-swing: what takes the swing out of the load. State and reference in, volts (or a correction of the
/// reference) out.
#include "crane/runtime/joined_component.hpp"
#include "crane/runtime/process.hpp"

namespace crane::services {

/// Joins crane/state and crane/reference; publishes crane/anti_swing.
[[nodiscard]] runtime::ComponentSpec anti_swing_spec();

}  // namespace crane::services
