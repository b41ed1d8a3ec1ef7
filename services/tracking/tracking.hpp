#pragma once
/// Tracking: what keeps each axis on its reference. State and reference in, volts out.
#include <optional>

#include "crane/runtime/joined_component.hpp"
#include "crane/runtime/process.hpp"

namespace crane::services {

/// Joins crane/state and crane/reference, and crane/anti_swing for controllers whose anti-swing law corrects
/// the reference; publishes crane/tracking.
[[nodiscard]] runtime::ComponentSpec tracking_spec();

}  // namespace crane::services
