#pragma once
/// Client side of crane/request and crane/reply, for an operator or a tool.
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "crane/bus/bus.hpp"
#include "crane/control/excitation.hpp"
#include "crane/runtime/convert.hpp"

namespace crane::stack {

/// Content of a request, without header, id and client.
struct OperatorRequest {
  crane_RequestKind kind = crane_REQUEST_NONE;
  std::array<bool, 3> selected{};                        ///< trolley, slew, hoist
  std::array<double, 3> target{};                        ///< move, follow: m, rad, m of cable
  std::array<double, 2> kick_radps{};                    ///< kick: radial, tangential
  std::uint64_t apply_tick = 0;                          ///< lockstep: tick of the execution; 0: at once
  std::uint64_t until_tick = 0;                          ///< advance: last tick
  std::vector<crane_Sine> sines{};                       ///< follow: at most four
  double duration_s = 0;                                 ///< follow: duration
  crane_OperatingMode mode = crane_MODE_SEMI_AUTOMATIC;  ///< mode: new operating mode
  /// Header of the newest crane/supervisor that this client has received. In real time, the supervisor
  /// refuses a request that names a tick older than 2 s or older than the last stop, unless the request stops
  /// the crane.
  msg::Header newest_status{};
};

/// Request to follow an excitation.
[[nodiscard]] OperatorRequest request_to_follow(const control::Excitation& excitation);

class OperatorClient {
 public:
  /// @param first_id  first id; must differ between clients that run at the same time
  OperatorClient(bus::Bus& bus, std::string client, std::uint64_t first_id);

  /// Number of processes that receive requests.
  [[nodiscard]] int listeners() const { return requests_.matched(); }
  /// Number of processes that can reply.
  [[nodiscard]] int answerers() const { return replies_.matched(); }
  /// @return id of the request
  std::uint64_t send(const OperatorRequest& wanted);
  /// Sends an unanswered request again, under a new id. Without keys, a forged packet can make readers skip
  /// all later samples of a DDS writer. Therefore repetitions with an odd number use a spare
  /// writer. After kUnanswered unanswered repetitions of this writer, a new spare writer replaces
  /// it. A spare writer whose repetition is answered becomes the first writer. With keys, such
  /// packets cannot be forged: all repetitions use one writer.
  /// @param repetition  number of the repetition of this request, from 1
  /// @return id of the repetition
  std::uint64_t repeat(const OperatorRequest& wanted, std::size_t repetition);
  /// A spare writer of the dashboard exists for 1 s, the longest discovery between two DDS vendors.
  static constexpr std::size_t kUnanswered = 5;
  /// The newest request of send(), without header and checksum, which the bus adds.
  [[nodiscard]] const msg::Request& last_sent() const { return last_sent_; }
  /// Sends a request that is always refused, because its id is 0 (kProbe). The reply proves that requests
  /// reach the supervisor and replies reach this client; other readers of crane/request do not reply.
  void probe();
  static constexpr std::uint64_t kProbe = 0;
  /// Takes the replies that have arrived.
  void receive();
  /// Removes and returns the first reply to `id` from `source`. A scheduled request has two replies;
  /// `scheduled` selects the first one (true) or the second one (false).
  [[nodiscard]] std::optional<msg::Reply> take_reply(std::uint64_t id, crane_Source source,
                                                     bool scheduled = false);

 private:
  /// Writer of every other repetition.
  struct Spare {
    bus::Publisher<msg::Request> requests;
    std::vector<std::uint64_t> ids{};  ///< of the repetitions
  };
  std::uint64_t send(const OperatorRequest& wanted, bus::Publisher<msg::Request>& writer);
  void prefer_answered_writer(std::uint64_t id);

  bus::Bus& bus_;
  bus::Publisher<msg::Request> requests_;
  std::optional<Spare> spare_;
  bus::Subscriber<msg::Reply> replies_;
  std::string client_;
  std::uint64_t next_id_;
  msg::Request last_sent_{};
  std::vector<msg::Reply> received_;
};

}  // namespace crane::stack
