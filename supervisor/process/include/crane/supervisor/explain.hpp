#pragma once
/// Explains which requests the present state refuses: the answers that the supervisor would give, according
/// to the published samples of supervisor and bridge.
#include <string>
#include <vector>

#include "crane/topics.hpp"

namespace crane::supervisor {

struct Explained {
  const char* request;  ///< "reset", "arm", "move", "home"
  bool accepted = false;
  std::string reason;  ///< reason and remedy; empty when accepted
};

/// The topics do not show every input of the supervisor, for example the time since the last cause. The
/// answers assume that these inputs permit the request; docs/safety.md lists the assumptions.
/// @param state  null: no state
[[nodiscard]] std::vector<Explained> explain(const msg::SupervisorStatus& status, const msg::State* state);

}  // namespace crane::supervisor
