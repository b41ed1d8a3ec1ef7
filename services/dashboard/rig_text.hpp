#pragma once
/// Data of a rig file for the page: kind, load, soft limits, and limits of the planner.
#include <string>

#include "crane/configuration/rig.hpp"

namespace crane::dashboard {

/// @return JSON text
[[nodiscard]] std::string rig_text(const configuration::Rig& rig);

}  // namespace crane::dashboard
