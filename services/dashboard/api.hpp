#pragma once
/// What each path answers. No sockets: the session reads a request and sends the answer. docs/dashboard.md
/// lists the paths.
#include <functional>
#include <string>
#include <string_view>

#include "dashboard/access.hpp"
#include "dashboard/metrics.hpp"
#include "dashboard/request_desk.hpp"

namespace crane::dashboard {

struct ApiRequest {
  std::string method, target;  ///< "GET", "/api/history?topic=crane/state"
  std::string content_type, body;
  std::string seat_key;  ///< header X-Crane-Seat
  Visitor visitor;       ///< its views must outlive the call
};

struct ApiAnswer {
  unsigned status = 200;
  std::string media_type = "application/json";
  std::string body;
  std::string_view file{};  ///< not empty: bytes that live as long as the program; `body` is then unused
};
using Answer = std::function<void(ApiAnswer)>;

class Api {
 public:
  /// @param send  hands a request of the operator to the thread of the bus; empty: nobody operates
  Api(Model& model, const AccessRules& rules, std::function<void(const stack::Wish&, Answered)> send,
      std::function<ServerCounts()> counts);

  /// Calls `answer` once: at once, or when the supervisor has answered.
  void handle(const ApiRequest& request, Answer answer);

 private:
  [[nodiscard]] ApiAnswer get(const ApiRequest& request);
  void post(const ApiRequest& request, Answer answer);
  [[nodiscard]] ApiAnswer about(const Visitor& visitor) const;
  [[nodiscard]] ApiAnswer history(std::string_view query) const;
  [[nodiscard]] ApiAnswer take_seat(const ApiRequest& request);
  void request(const ApiRequest& request, Answer answer);

  Model& model_;
  const AccessRules& rules_;
  std::function<void(const stack::Wish&, Answered)> send_;
  std::function<ServerCounts()> counts_;
};

}  // namespace crane::dashboard
