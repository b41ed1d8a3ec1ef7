#pragma once
/// Answers the requests to each HTTP path (docs/dashboard.md lists the paths). No sockets: the session reads
/// a request and sends the answer.
#include <functional>
#include <string>
#include <string_view>

#include "dashboard/api_types.hpp"
#include "dashboard/metrics.hpp"
#include "dashboard/request_sender.hpp"
#include "dashboard/runs_api.hpp"

namespace crane::dashboard {

using AnswerHandler = std::function<void(ApiAnswer)>;

class Api {
 public:
  /// @param send  passes a request of the operator to the bus thread; empty: nobody may operate
  Api(Model& model, const AccessRules& rules,
      std::function<void(const stack::OperatorRequest&, Answered)> send, std::function<ServerCounts()> counts,
      const RunsOptions& runs);

  /// Calls `answer` exactly once: immediately, or when the supervisor has answered.
  void handle(const ApiRequest& request, AnswerHandler answer);
  /// True for a stop that this visitor may request without a token or with a wrong token.
  [[nodiscard]] bool is_permitted_stop(const ApiRequest& request) const;
  /// Starts waiting jobs and collects finished ones.
  void poll() { runs_.poll(); }

 private:
  [[nodiscard]] ApiAnswer get(const ApiRequest& request);
  void post(const ApiRequest& request, AnswerHandler answer);
  [[nodiscard]] ApiAnswer newest_status() const;
  [[nodiscard]] ApiAnswer about(const Visitor& visitor) const;
  [[nodiscard]] ApiAnswer history(std::string_view query) const;
  [[nodiscard]] ApiAnswer take_seat(const ApiRequest& request);
  void request(const ApiRequest& request, AnswerHandler answer);

  Model& model_;
  const AccessRules& rules_;
  std::function<void(const stack::OperatorRequest&, Answered)> send_;
  std::function<ServerCounts()> counts_;
  RunsApi runs_;
};

}  // namespace crane::dashboard
