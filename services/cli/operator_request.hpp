#pragma once
/// One request to the supervisor of a running crane, and its answer.
#include <string>

#include "cli/tool_bus.hpp"
#include "stack/operator_client.hpp"

namespace crane::cli {

struct Answer {
  std::uint64_t id = 0;
  bool accepted = false;
  std::string reason;  ///< why not
};

/// The supervisor (of a move: or the trajectory planner) is not there or does not answer; says where it was
/// looked for and what to check.
class NoAnswer : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Patience {
  double find_s = 5;   ///< for those who have to hear it to be found
  double reply_s = 2;  ///< for its reply
};

/// Stop and emergency stop are sent as soon as anybody listens and again until answered: they do no harm
/// twice. A move is sent once the trajectory planner has been found, too: what it has not heard the
/// supervisor would accept in vain.
/// @throws NoAnswer
[[nodiscard]] Answer ask(bus::Bus& bus, const stack::Wish& wish, const Patience& patience = {});

/// "accepted" on standard output, or the reason on standard error. @return exit code
int report(const char* what, const Answer& answer);

}  // namespace crane::cli
