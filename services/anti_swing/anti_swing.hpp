#pragma once
/// The process of the anti-swing law, which damps the swing of the load. Input: state and reference; output:
/// volts, or a correction of the reference.
#include "crane/runtime/joined_component.hpp"
#include "crane/runtime/process.hpp"

namespace crane::services {

/// Joins crane/state and crane/reference; publishes crane/anti_swing.
[[nodiscard]] runtime::ComponentSpec anti_swing_spec();

}  // namespace crane::services
