#pragma once
/// Receives the requests of operators and tools for one process, keeps them until they are due, and answers
/// them on crane/reply.
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "crane/runtime/component.hpp"
#include "crane/runtime/recent_ticks.hpp"
#include "crane/runtime/request_kinds.hpp"

namespace crane::runtime {

class RequestInbox {
 public:
  /// Maximum number of requests that wait for their tick. A scripted run schedules fewer than ten; the limit
  /// bounds the memory when a sender floods the topic.
  static constexpr std::size_t kMostWaiting = 256;
  /// Further places for requests that stop the crane at once.
  static constexpr std::size_t kMostStops = 64;
  /// Requests that are due later than this are refused: 2.8 hours at 100 Hz.
  static constexpr std::uint64_t kFarthest_ticks = 1'000'000;

  /// @param kinds  kinds of request that this process executes; it ignores all others
  RequestInbox(const Context& context, std::initializer_list<crane_RequestKind> kinds);

  /// Takes up to 64 requests from the bus. Ignores requests whose source may not write
  /// crane/request. Refuses a request when kMostWaiting requests wait; kMostStops further places
  /// are reserved for stops that act at once. In lockstep, answers a request for a later tick with
  /// the reason "scheduled". In real time, refuses a request for a later tick, which could start a
  /// motion after its operator has left or after a stop; a stop for a later tick acts at once.
  /// @return true when a request arrived
  bool receive();
  /// Call at each tick of this run. @param now_ns  local time of the tick
  void stepped(const msg::Header& header, std::int64_t now_ns) { ticks_.add(header, now_ns); }
  /// Call when the crane stops. In real time, requests that name an earlier tick are then refused, except
  /// requests that stop the crane.
  void stopped(std::int64_t now_ns) { stopped_ns_ = now_ns; }
  /// @param sender  participant that sent the request
  /// @return the next request that is due at `tick`, in the order of arrival; nothing when there is none.
  ///   Refuses requests that are due later than kFarthest_ticks after `tick`. In real time, a
  ///   request that does not stop the crane must name (in its header: tick and sample time) a tick
  ///   of this run (stepped()) that is at most kRequestLife_s old and not before the last stop; it
  ///   is refused otherwise.
  [[nodiscard]] std::optional<msg::Request> take_due(std::uint64_t tick, std::int64_t now_ns,
                                                     bus::ParticipantId* sender = nullptr);
  void reply(const msg::Request& request, const msg::Header& header, bool accepted, std::string_view reason);

 private:
  struct Waiting {
    msg::Request request;
    bus::ParticipantId sender;
  };
  /// @return why the request is obsolete; empty: the request is not obsolete
  [[nodiscard]] std::string_view obsolete_because(const msg::Request& request, std::int64_t now_ns) const;
  void refuse_untimely(std::uint64_t tick, std::int64_t now_ns);

  bool schedules_;  ///< lockstep: requests may wait for their tick
  RecentTicks ticks_;
  std::int64_t stopped_ns_ = std::numeric_limits<std::int64_t>::min();  ///< local time of the last stop
  bus::Subscriber<msg::Request> requests_;
  Output<msg::Reply> replies_;
  std::vector<crane_RequestKind> kinds_;
  std::vector<Waiting> waiting_;
};

}  // namespace crane::runtime
