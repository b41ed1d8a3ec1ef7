#pragma once
/// Counts of the encoders at the start of the bridge.
#include <array>
#include <cstdint>

#include "crane/bridge/board.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bridge {

/// Counts at [start] of the rig file; for an axis with homing at unhomed_position(). The counts can exceed
/// the 24 bits of a counter: a card holds the low 24 bits, and CountUnwrapper adds the rest.
[[nodiscard]] std::array<std::int64_t, kCounters> start_counts(const configuration::Rig& rig);

}  // namespace crane::bridge
