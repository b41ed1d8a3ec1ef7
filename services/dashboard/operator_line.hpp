#pragma once
/// Carries what the page asks for from the thread of the network to the request desk in the thread of the
/// bus.
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
  /// Sends what was asked for and takes the answers. Of the thread of the bus.
  void poll();

 private:
  struct Asked {
    stack::Wish wish;
    Answered answered;
  };
  std::optional<RequestDesk> desk_;
  Inbox<Asked> asked_{kMostConnections};  ///< one of each connection at most: none is refused
};

}  // namespace crane::dashboard
