#pragma once
/// Requests of operators and tools as one process sees them: kept until they are due, answered on
/// crane/reply.
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include "crane/runtime/component.hpp"

namespace crane::runtime {

class RequestInbox {
 public:
  /// @param kinds what this process acts on; everything else is ignored
  RequestInbox(const Context& context, std::initializer_list<crane_RequestKind> kinds);

  /// Takes what has arrived; confirms requests for a later tick with the reason "scheduled".
  /// @return true when something arrived
  bool receive();
  /// The next request due on `tick`, in the order of arrival; nothing when there is none.
  [[nodiscard]] std::optional<msg::Request> take_due(std::uint64_t tick);
  void reply(const msg::Request& request, const msg::Header& header, bool accepted, std::string_view reason);

 private:
  bus::Subscriber<msg::Request> requests_;
  Output<msg::Reply> replies_;
  std::vector<crane_RequestKind> kinds_;
  std::vector<msg::Request> waiting_;
};

}  // namespace crane::runtime
