#pragma once
/// Sends one request to the supervisor of a running crane and waits for the answer.
#include <string>

#include "cli/tool_bus.hpp"
#include "crane/runtime/request_kinds.hpp"
#include "stack/operator_client.hpp"

namespace crane::cli {

struct Answer {
  std::uint64_t id = 0;
  bool accepted = false;
  std::string reason;  ///< reason of a refusal
};

/// The supervisor (for a move also the trajectory planner) was not found or does not answer. what() names
/// domain and crane and the remedy.
class NoAnswer : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Opens the bus for a request of this kind. For a request that stops the crane, the message of a failure
/// (for example expired keys) also states how to stop the crane without the bus.
/// @throws configuration::ConfigurationError, bus::Error, std::runtime_error
[[nodiscard]] bus::Bus open_bus_for(crane_RequestKind kind, const runtime::BusOptions& options);

/// Client name of the requests of this program.
[[nodiscard]] std::string client_name();

struct Patience {
  double find_s = 5;                         ///< longest time for the discovery of the receivers
  double reply_s = runtime::kRequestLife_s;  ///< longest time for the reply
};

/// With keys, each participant of the crane first checks the keys of this program, and the check takes longer
/// with every observer and on a busy computer.
inline constexpr Patience kStopWithKeys{.find_s = 30, .reply_s = 30};

/// Patience for a request of this kind. @param keys  true: the crane uses DDS Security
[[nodiscard]] Patience patience_for(crane_RequestKind kind, bool keys);

/// Sends the request and waits for the answer. A stop or emergency stop is sent as soon as crane/request has
/// a reader, and is repeated every 100 ms until the answer. Any other request is
/// sent once, after the supervisor has answered a probe; a move or a session of the stick also waits for a
/// sample of crane/reference. A request that stops the crane prints every 3 s on standard error that no
/// answer has arrived, and how to stop the crane without the bus.
/// @param wanted  without `newest_status`, the request names the newest status that this program receives;
///   with it, the supervisor refuses the request if the crane has stopped since this status
/// @throws NoAnswer
[[nodiscard]] Answer ask(bus::Bus& bus, const stack::OperatorRequest& wanted, const Patience& patience);
/// The same with patience_for().
[[nodiscard]] Answer ask(bus::Bus& bus, const stack::OperatorRequest& wanted);

/// Repeats the request `stop` every 20 ms until the supervisor answers. A stop signal to this program does
/// not end the wait.
/// @return false when the supervisor has not answered within `patience_s`
bool stop_crane(bus::Bus& bus, double patience_s = 5);

/// Prints "accepted" on standard output, or the reason on standard error. @return exit code
int report(const char* what, const Answer& answer);

}  // namespace crane::cli
