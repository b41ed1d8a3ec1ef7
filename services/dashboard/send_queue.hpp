#pragma once
/// Messages that wait to be sent to one client; drops samples when the client is slow. No sockets and
/// no clock.
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace crane::dashboard {

using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;

enum class Keep : std::uint8_t {
  may_drop,  ///< a sample of every tick: dropped while the client is slow, and counted
  newest,    ///< a document that replaces its predecessor: only the newest of each channel waits
  always     ///< an event, a reply, an answer to the client: never dropped
};

struct Outgoing {
  std::uint32_t channel = 0;  ///< channel of a Keep::newest document
  Keep keep = Keep::always;
  bool binary = true;
  std::string head;  ///< differs from client to client
  Bytes payload;     ///< shared by all clients; may be null

  [[nodiscard]] std::size_t bytes() const { return head.size() + (payload ? payload->size() : 0); }
};

class SendQueue {
 public:
  /// Waiting bytes above which samples are dropped: about 3 s of all topics at 100 Hz.
  static constexpr std::size_t kDropAbove_bytes = 1U << 20U;
  /// Waiting bytes at which the client is disconnected. The client then reconnects and receives every
  /// document again.
  static constexpr std::size_t kGiveUpAbove_bytes = 4U << 20U;

  /// @return false when the client must be disconnected
  [[nodiscard]] bool put(Outgoing message);
  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  [[nodiscard]] Outgoing take();

  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  std::deque<Outgoing> waiting_;
  std::size_t bytes_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace crane::dashboard
