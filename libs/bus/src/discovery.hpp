#pragma once
/// Discovery of participants. Both vendors must use the same kind (multicast or unicast), hence one rule.
#include "crane/bus/bus.hpp"

namespace crane::bus {

/// @return true with explicit peers, and when no interface has multicast (the usual Linux loop-back). Every
///   participant then contacts the known ports of its own host and of the peers
[[nodiscard]] bool discovers_by_unicast(const Options& options);

}  // namespace crane::bus
