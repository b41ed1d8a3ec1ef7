#pragma once
/// Passes requests of the page from the network thread to the request sender in the bus thread.
#include <optional>

#include "dashboard/connection_limits.hpp"
#include "dashboard/inbox.hpp"
#include "dashboard/request_sender.hpp"

namespace crane::dashboard {

class RequestQueue {
 public:
  /// @param operates  true: creates the writer of crane/request
  RequestQueue(bus::Bus& bus, bool operates) {
    if (operates) sender_.emplace(bus);
  }

  /// May be called by any thread. @return false when the queue is full; this cannot happen while
  /// each connection sends one request at a time
  bool ask(const stack::OperatorRequest& wanted, Answered answered) {
    return queue_.put({wanted, std::move(answered)});
  }
  /// Sends the requests and takes the answers. Called by the bus thread.
  void poll();

 private:
  struct Queued {
    stack::OperatorRequest wanted;
    Answered answered;
  };
  std::optional<RequestSender> sender_;
  Inbox<Queued> queue_{kMostConnections};
};

}  // namespace crane::dashboard
