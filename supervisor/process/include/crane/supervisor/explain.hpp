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

/// Assumes that durations have passed which the topics do not show (causes inactive for a second, inputs
/// complete for a second). Doubt about positions after a restart of the bridge is not shown. @param state
/// null: no state
[[nodiscard]] std::vector<Explained> explain(const msg::SupervisorStatus& status, const msg::State* state);

}  // namespace crane::supervisor
