#pragma once
/// The side of the bus: takes the samples of every topic, and sends the requests of the page. It reads what
/// the tools read; the loop does not notice it.
#include <functional>
#include <memory>
#include <optional>

#include "dashboard/connection_limits.hpp"
#include "dashboard/inbox.hpp"
#include "dashboard/request_desk.hpp"
#include "dashboard/sample.hpp"

namespace crane::dashboard {

class Observer {
 public:
  using Deliver = std::function<void(std::vector<SamplePtr>)>;
  /// @param operates  true: creates the writer of crane/request
  Observer(bus::Bus& bus, bool operates, Deliver deliver);

  /// Takes and hands on what has arrived, sends what was asked for. Waits at most 20 ms.
  void poll();
  /// May be called by any thread. @return false when too many requests wait
  bool ask(const stack::Wish& wish, Answered answered) { return asked_.put({wish, std::move(answered)}); }

 private:
  struct Asked {
    stack::Wish wish;
    Answered answered;
  };
  bus::Bus& bus_;
  Deliver deliver_;
  std::vector<bus::CdrSubscriber> readers_;
  std::optional<RequestDesk> desk_;
  Inbox<Asked> asked_{kMostConnections};  ///< one of each connection at most: none is refused
};

}  // namespace crane::dashboard
