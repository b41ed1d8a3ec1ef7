#pragma once
/// What the three back ends share: one interface, one translation of quality of service, one doorbell.
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "crane/bus/bus.hpp"

namespace crane::bus {

/// Rung by every reader of a bus when something arrives; remembers a ring nobody waited for.
class Doorbell {
 public:
  void ring() {
    {
      const std::lock_guard lock{mutex_};
      if (rung_) return;
      rung_ = true;
    }
    condition_.notify_one();
  }
  bool wait(std::chrono::nanoseconds timeout) {
    std::unique_lock lock{mutex_};
    const bool rung = condition_.wait_for(lock, timeout, [this] { return rung_; });
    rung_ = false;
    return rung;
  }

 private:
  std::mutex mutex_;
  std::condition_variable condition_;
  bool rung_ = false;
};

/// Tells an endpoint's owner what happened.
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

/// topics::Qos in numbers. Every writer and reader is RELIABLE and KEEP_LAST. A Fast DDS reader takes the
/// past of a TRANSIENT_LOCAL Cyclone DDS writer even unasked, so writers whose past may do harm (requests) or
/// mislead (the loop in real time) do not offer it.
struct Quality {
  int depth = 1;                ///< samples kept per instance
  int instances = 1;            ///< most instances of a keyed topic
  bool writer_history = false;  ///< writer offers TRANSIENT_LOCAL
  bool reader_history = false;  ///< reader asks for it
};
[[nodiscard]] Quality quality(const topics::Description& topic, const EndpointOptions& endpoint);

/// Name of a DDS policy from its number, which both vendors take from the standard.
[[nodiscard]] std::string_view policy_name(int id);

/// One participant of one vendor. Endpoints keep it alive.
class BackEnd : public std::enable_shared_from_this<BackEnd> {
 public:
  BackEnd() = default;
  BackEnd(const BackEnd&) = delete;
  BackEnd& operator=(const BackEnd&) = delete;
  virtual ~BackEnd() = default;
  virtual std::unique_ptr<detail::Writer> writer(const topics::Description&, const EndpointOptions&) = 0;
  virtual std::unique_ptr<detail::Reader> reader(const topics::Description&, const EndpointOptions&) = 0;
};

/// `options.peers` are IPv4 addresses here. @throws Error
std::shared_ptr<BackEnd> make_cyclone(const Options&, std::shared_ptr<Doorbell>);
std::shared_ptr<BackEnd> make_fastdds(const Options&, std::shared_ptr<Doorbell>);
std::shared_ptr<BackEnd> make_memory(const Options&, std::shared_ptr<Doorbell>);

/// Checks what no vendor explains well, and resolves host names of peers. @throws Error with all problems
[[nodiscard]] Options checked(Options options);

}  // namespace crane::bus
