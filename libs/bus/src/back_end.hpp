#pragma once
/// Shared by the three back ends: interface, quality of service in numbers, wake-up of Bus::wait().
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "crane/bus/path_stamps.hpp"
#include "endpoint.hpp"

namespace crane::bus {

/// Wakes Bus::wait(). Every reader of a bus rings when a sample arrives. A ring is stored until the next
/// wait. If `rung_` is already set, ring() has no effect: the woken thread clears `rung_` before it
/// reads the queues, and therefore finds the later sample, too. This order requires sequential
/// consistency.
class Doorbell {
 public:
  /// A sample of `topic` has arrived.
  void ring(std::string_view topic) {
    if (auto* const stamps = path_stamps()) stamps->arrived(topic);
    on_arrival_ ? on_arrival_(topic) : ring();
  }
  void ring() {
    if (rung_) return;
    {
      const std::lock_guard lock{mutex_};
      rung_ = true;
    }
    condition_.notify_one();
  }
  /// From now on, samples call `on_arrival` and no longer wake wait(). Call before the first
  /// endpoint exists.
  void set_arrival_handler(ArrivalHandler on_arrival) { on_arrival_ = std::move(on_arrival); }
  bool wait(std::chrono::nanoseconds timeout) {
    if (timeout.count() <= 0) return rung_ && rung_.exchange(false);
    std::unique_lock lock{mutex_};
    condition_.wait_for(lock, timeout, [this] { return rung_.load(); });
    return rung_.exchange(false);
  }

 private:
  ArrivalHandler on_arrival_;
  std::mutex mutex_;
  std::condition_variable condition_;
  std::atomic<bool> rung_ = false;  ///< set under the mutex
};

/// Calls the event handler of an endpoint.
struct Announcer {
  EventHandler handler;
  std::string_view topic;
  void operator()(EventKind kind, int current = 0, std::string_view policy = {}) const {
    if (handler) handler({kind, topic, current, policy});
  }
  void matched(int change, int current) const {
    (*this)(change > 0 ? EventKind::matched : EventKind::unmatched, current);
  }
};

/// Numbers of topics::Qos. Every writer and reader is RELIABLE and KEEP_LAST. A volatile Fast DDS reader also
/// receives the history of a TRANSIENT_LOCAL Cyclone DDS writer. Therefore writers of requests and of
/// real-time loop topics, whose old samples must not be received, do not offer TRANSIENT_LOCAL.
struct Quality {
  int depth = 1;                ///< samples kept per instance
  int instances = 1;            ///< most instances of a keyed topic
  bool writer_history = false;  ///< writer offers TRANSIENT_LOCAL
  bool reader_history = false;  ///< reader requests TRANSIENT_LOCAL
};
[[nodiscard]] Quality quality(const topics::Description& topic, const EndpointOptions& endpoint);

/// Name of a DDS policy. Both vendors use the policy numbers of the DDS standard.
[[nodiscard]] std::string_view policy_name(int id);

/// One participant of one vendor. Its endpoints keep the participant alive. Several buses may share it.
class BackEnd : public std::enable_shared_from_this<BackEnd> {
 public:
  BackEnd() = default;
  BackEnd(const BackEnd&) = delete;
  BackEnd& operator=(const BackEnd&) = delete;
  virtual ~BackEnd() = default;
  virtual std::unique_ptr<detail::Writer> writer(const topics::Description&, const EndpointOptions&) = 0;
  /// @param doorbell  of the bus that owns the reader
  virtual std::unique_ptr<detail::Reader> reader(const topics::Description&, const EndpointOptions&,
                                                 std::shared_ptr<Doorbell> doorbell) = 0;
  virtual std::vector<OtherVersion> other_versions() { return {}; }
  virtual std::vector<FoundEndpoint> found_endpoints() { return {}; }
  /// UntypedSubscriber::origin_of() of a writer of the participant.
  virtual std::string origin_of(const ParticipantId& /*participant*/) { return {}; }
};

/// `options.peers` are IPv4 addresses here. @throws Error
std::shared_ptr<BackEnd> make_cyclone(const Options&);
std::shared_ptr<BackEnd> make_fastdds(const Options&);
std::shared_ptr<BackEnd> make_memory(const Options&);

/// Checks the options and resolves the host names of the peers. A wrong option gives a message with the
/// remedy.
/// @throws Error with all problems
[[nodiscard]] Options checked(Options options);

}  // namespace crane::bus
