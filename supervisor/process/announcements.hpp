#pragma once
/// Events of the supervisor, each with its remedy.
#include "crane/runtime/node.hpp"
#include "crane/supervisor/supervisor.hpp"

namespace crane::supervisor {

/// Reports a change of state and its cause. @param homing_axis  axis of the last homing
void announce(runtime::Node& node, const Limits& limits, const TickOutput& output, std::size_t homing_axis);
/// Reports a state that is not used because its sample time contradicts its tick.
void announce_wrong_time(runtime::Node& node, const msg::Header& header);
/// Reports that the crane is armed without the checks that need the model of the rig file.
void announce_unchecked(runtime::Node& node);

}  // namespace crane::supervisor
