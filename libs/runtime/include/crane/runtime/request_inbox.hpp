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
  /// Requests that may wait for their tick. A move, its kicks and its stop are a handful; a flood must not
  /// fill the memory.
  static constexpr std::size_t kMostWaiting = 256;
  /// More that are kept when they stop the crane now.
  static constexpr std::size_t kMostStops = 64;
  /// Requests for a later tick than this many from now are refused: 2.8 hours at 100 Hz.
  static constexpr std::uint64_t kFarthest_ticks = 1'000'000;

  /// @param kinds what this process acts on; everything else is ignored
  RequestInbox(const Context& context, std::initializer_list<crane_RequestKind> kinds);

  /// Takes what has arrived, 64 requests at most; confirms requests for a later tick with the reason
  /// "scheduled", and refuses those that find no room.
  /// @return true when something arrived
  bool receive();
  /// The next request due on `tick`, in the order of arrival; nothing when there is none. Refuses requests
  /// that are due later than kFarthest_ticks after `tick`.
  [[nodiscard]] std::optional<msg::Request> take_due(std::uint64_t tick);
  void reply(const msg::Request& request, const msg::Header& header, bool accepted, std::string_view reason);

 private:
  bus::Subscriber<msg::Request> requests_;
  Output<msg::Reply> replies_;
  std::vector<crane_RequestKind> kinds_;
  void refuse_too_late(std::uint64_t tick);
  std::vector<msg::Request> waiting_;
};

}  // namespace crane::runtime
