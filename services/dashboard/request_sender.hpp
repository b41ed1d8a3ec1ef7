#pragma once
/// Sends the requests of the page on crane/request and collects the supervisor's answers without blocking.
/// Used by the bus thread.
#include <functional>
#include <list>

#include "stack/operator_client.hpp"

namespace crane::dashboard {

struct Reply {
  bool accepted = false;
  std::string reason;  ///< reason of the refusal
};
using Answered = std::function<void(Reply)>;

class RequestSender {
 public:
  explicit RequestSender(bus::Bus& bus);

  /// Maximum number of requests that wait for an answer. Stops do not count: all stops of one kind share one
  /// request.
  static constexpr std::size_t kMostWaiting = 16;

  void send(const stack::OperatorRequest& wanted, Answered answered);
  /// Takes answers, repeats stops, and abandons requests that are not answered in time.
  void poll(std::int64_t now_ns);

 private:
  struct Pending {
    stack::OperatorRequest wanted;
    std::vector<Answered> answered;  ///< callbacks of all clients that requested the same stop
    std::vector<std::uint64_t> ids;  ///< ids of the request and of its repetitions, until they are answered
    std::int64_t sent_ns = 0, repeat_ns = 0;
    bool done = false;
  };
  void advance(Pending& pending, std::int64_t now_ns);
  void publish(Pending& pending, std::int64_t now_ns);
  [[nodiscard]] std::optional<Reply> take_reply(Pending& pending);
  [[nodiscard]] Pending* same_stop(crane_RequestKind kind);

  stack::OperatorClient client_;
  std::list<Pending> pending_;
};

}  // namespace crane::dashboard
