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

/// The topics do not show how long the causes have been clear and the inputs have been fresh: the answers
/// assume the required second. They do not consider whether a position is doubtful after a restart of the
/// bridge. @param state  null: no state
[[nodiscard]] std::vector<Explained> explain(const msg::SupervisorStatus& status, const msg::State* state);

}  // namespace crane::supervisor
