#pragma once
/// How participants find each other: one rule for both vendors, so that they always use the same way.
#include "crane/bus/bus.hpp"

namespace crane::bus {

/// True with explicit peers, and where no interface has multicast (the usual Linux loop-back): every
/// participant then asks the known ports of its own host and of the peers.
[[nodiscard]] bool discovers_by_unicast(const Options& options);

}  // namespace crane::bus
