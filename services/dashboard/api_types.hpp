#pragma once
/// An HTTP request and its answer, without sockets.
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "dashboard/access.hpp"

namespace crane::dashboard {

struct ApiRequest {
  std::string method, target;  ///< "GET", "/api/history?topic=crane/state"
  std::string content_type, body;
  std::string seat_key;   ///< header X-Crane-Seat
  std::string status_id;  ///< header X-Crane-Seen: the newest crane/supervisor that the client has received
  Visitor visitor;        ///< its views must outlive the call
};

struct ApiAnswer {
  unsigned status = 200;
  std::string media_type = "application/json";
  std::string body;
  std::string_view file{};  ///< not empty: static bytes that replace `body`
  /// true: a page with scripts, sent with the policy `sandbox`, so that it cannot access the dashboard
  bool report = false;
};

[[nodiscard]] ApiAnswer json_answer(const nlohmann::ordered_json& json, unsigned status = 200);
/// {"error": what}
[[nodiscard]] ApiAnswer problem_answer(unsigned status, const std::string& what);

}  // namespace crane::dashboard
