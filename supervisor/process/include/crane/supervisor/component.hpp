#pragma once
/// The supervisor on the bus: joins crane/state, crane/demand and crane/reference, answers requests, and is
/// the only writer of crane/command. crane/supervisor/supervisor.hpp makes all decisions.
#include "crane/runtime/process.hpp"
#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

[[nodiscard]] runtime::ComponentSpec supervisor_spec();

/// Limits of the supervisor from the rig file.
[[nodiscard]] Limits limits_of(const configuration::Rig& rig);

}  // namespace crane::supervisor
