#pragma once
/// Passes requests of the page from the network thread to the request desk in the bus thread.
#include <optional>

#include "dashboard/connection_limits.hpp"
#include "dashboard/inbox.hpp"
#include "dashboard/request_desk.hpp"

namespace crane::dashboard {

class OperatorLine {
 public:
  /// @param operates  true: creates the writer of crane/request
  OperatorLine(bus::Bus& bus, bool operates) {
    if (operates) desk_.emplace(bus);
  }

  /// May be called by any thread. @return false when too many requests wait
  bool ask(const stack::Wish& wish, Answered answered) { return asked_.put({wish, std::move(answered)}); }
  /// Sends the requests and takes the answers. Called by the bus thread.
  void poll();

 private:
  struct Asked {
    stack::Wish wish;
    Answered answered;
  };
  std::optional<RequestDesk> desk_;
  Inbox<Asked> asked_{kMostConnections};  ///< at most one per connection, so that none is refused
};

}  // namespace crane::dashboard
