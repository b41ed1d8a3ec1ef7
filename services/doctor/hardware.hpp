#pragma once
/// Is the board of the rig file there, and may this user open it? Nothing is written to it.
#include "crane/configuration/rig.hpp"
#include "doctor/finding.hpp"

namespace crane::doctor {

[[nodiscard]] Findings examine_board(const configuration::Rig& rig);

}  // namespace crane::doctor
