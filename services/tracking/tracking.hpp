#pragma once
/// The process of the tracking law, which makes each axis follow its reference. Input: state and reference;
/// output: volts.
#include <optional>

#include "crane/runtime/joined_component.hpp"
#include "crane/runtime/process.hpp"

namespace crane::services {

/// Joins crane/state and crane/reference; also crane/anti_swing for controllers whose anti-swing law corrects
/// the reference. Publishes crane/tracking.
[[nodiscard]] runtime::ComponentSpec tracking_spec();

}  // namespace crane::services
