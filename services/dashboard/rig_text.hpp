#pragma once
/// What the page draws of a rig file: kind, load, soft limits, and how the planner moves.
#include <string>

#include "crane/configuration/rig.hpp"

namespace crane::dashboard {

/// JSON text.
[[nodiscard]] std::string rig_text(const configuration::Rig& rig);

}  // namespace crane::dashboard
