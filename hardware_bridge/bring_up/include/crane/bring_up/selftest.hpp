#pragma once
/// The rig is pushed a little, drive by drive, and watched: evidence for judge() of wiring.hpp.
/// The crane stands at [start] of the rig file, the load hangs nearly still, and there are 10 cm (0.2 rad) of
/// room around each axis.
#include <functional>
#include <string>

#include "crane/bring_up/wiring.hpp"

namespace crane::bring_up {

struct SelftestOptions {
  double largest_v = 4;  ///< pushes grow from 1 V to this until something moves, (0, kLargestJog_v]
  std::function<void(const std::string&)> progress = [](const std::string&) {};
};

/// Leaves the board at 0 V, brakes closed. Stops before moving anything when the emergency stop is pressed,
/// or the watchdog relay does not do its work. @throws Ended
[[nodiscard]] Evidence gather(Session& session, const SelftestOptions& options);

}  // namespace crane::bring_up
