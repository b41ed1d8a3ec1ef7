#pragma once
/// An operator's or tool's side of crane/request and crane/reply.
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "crane/bus/bus.hpp"
#include "crane/control/excitation.hpp"

namespace crane::stack {

/// What a request is about, without its bookkeeping.
struct Wish {
  crane_RequestKind kind = crane_REQUEST_NONE;
  std::array<bool, 3> selected{};
  std::array<double, 3> target{};   ///< move: m, rad, m of cable; kick: rad/s radial, tangential
  std::uint64_t apply_tick = 0;     ///< 0: at once
  std::uint64_t until_tick = 0;     ///< advance
  std::vector<crane_Sine> sines{};  ///< follow: at most as many as a request holds
  double duration_s = 0;            ///< follow
};

/// The request to follow an excitation.
[[nodiscard]] Wish wish_of(const control::Excitation& excitation);

class OperatorClient {
 public:
  /// @param first_id  ids count up from here; must differ between clients that run at the same time
  OperatorClient(bus::Bus& bus, std::string client, std::uint64_t first_id);

  /// Processes that would receive a request now.
  [[nodiscard]] int listeners() const { return requests_.matched(); }
  /// Processes that could answer.
  [[nodiscard]] int answerers() const { return replies_.matched(); }
  /// @return the request's id
  std::uint64_t send(const Wish& wish);
  /// Takes the replies that have arrived.
  void receive();
  /// First reply to `id` from `source`, taken out; `scheduled` says which of the two replies to a scheduled
  /// request.
  [[nodiscard]] std::optional<msg::Reply> take_reply(std::uint64_t id, crane_Source source,
                                                     bool scheduled = false);

 private:
  bus::Publisher<msg::Request> requests_;
  bus::Subscriber<msg::Reply> replies_;
  std::string client_;
  std::uint64_t next_id_;
  std::vector<msg::Reply> received_;
};

}  // namespace crane::stack
