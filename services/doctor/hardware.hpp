#pragma once
/// Checks that the board of the rig file exists and that this user may open it. Writes nothing to the board.
#include "crane/configuration/rig.hpp"
#include "doctor/finding.hpp"

namespace crane::doctor {

[[nodiscard]] Findings examine_board(const configuration::Rig& rig);

}  // namespace crane::doctor
