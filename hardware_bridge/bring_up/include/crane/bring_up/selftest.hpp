#pragma once
/// Pushes each drive over a short distance and records the reaction of the rig as evidence for judge() of
/// wiring.hpp.
/// @pre the crane is at [start] of the rig file, the load hangs nearly at rest, and each axis has
///   10 cm (0.2 rad) of free travel in both directions
#include <functional>
#include <string>

#include "crane/bring_up/wiring.hpp"

namespace crane::bring_up {

struct SelftestOptions {
  /// The voltage of the pushes increases from 1 V up to this value until an axis moves; in (0,
  /// kLargestJog_v].
  double largest_v = 4;
  std::function<void(const std::string&)> progress = [](const std::string&) {};
};

/// Leaves the board at 0 V with closed brakes. Ends before any motion when the emergency stop is pressed or
/// the watchdog relay does not work. @throws Ended
[[nodiscard]] Evidence gather(Session& session, const SelftestOptions& options);

}  // namespace crane::bring_up
