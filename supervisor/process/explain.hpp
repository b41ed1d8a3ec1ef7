#pragma once
/// Why the present state refuses what: the answers the supervisor would give, from what it and the bridge
/// publish.
#include <string>
#include <vector>

#include "crane/topics.hpp"

namespace crane::supervisor {

struct Explained {
  const char* request;  ///< "reset", "arm", "move", "home"
  bool accepted = false;
  std::string reason;  ///< why not, and what to do; empty when accepted
};

/// Durations that the topics do not show (causes clear for a second, streams complete for a second) count as
/// over; doubt about positions after a new start of the bridge is not shown either. @param state  null: none
[[nodiscard]] std::vector<Explained> explain(const msg::SupervisorStatus& status, const msg::State* state);

}  // namespace crane::supervisor
