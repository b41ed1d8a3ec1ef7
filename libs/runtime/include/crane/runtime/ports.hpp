#pragma once
/// The endpoints of one component: those its ComponentSpec declares, and no others.
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "crane/bus/bus.hpp"
#include "crane/runtime/loop_reader.hpp"
#include "crane/runtime/wiring.hpp"

namespace crane::runtime {

enum class Clock : std::uint8_t {
  realtime,  ///< the clock master ticks with CLOCK_MONOTONIC; processes that are late lose the tick
  lockstep   ///< the plant advances when command k has come; no process is ever late, and runs repeat bit for
             ///< bit
};

/// Endpoints of the loop. In real time only what comes from now on counts; in lockstep every tick from the
/// first, also for a process that joins a moment later.
[[nodiscard]] inline bus::EndpointOptions loop_endpoint(Clock clock) {
  bus::EndpointOptions endpoint;
  endpoint.history = clock == Clock::lockstep;
  return endpoint;
}

/// One output. A sample that the vendor refuses is counted and reported by the process (node.hpp).
template <class T>
class Output {
 public:
  Output(std::shared_ptr<bus::Publisher<T>> publisher, std::shared_ptr<std::uint64_t> refused)
      : publisher_{std::move(publisher)}, refused_{std::move(refused)} {}
  void publish(const T& sample) {
    if (!publisher_->publish(sample)) ++*refused_;
  }

 private:
  std::shared_ptr<bus::Publisher<T>> publisher_;
  std::shared_ptr<std::uint64_t> refused_;
};

class Ports {
 public:
  /// Everything must outlive the ports.
  Ports(bus::Bus& bus, const ComponentSpec& spec, const control::Controller& controller, Clock clock)
      : bus_{bus}, spec_{spec}, controller_{controller}, clock_{clock} {}

  /// A loop topic: samples of one writer. @throws std::logic_error when the spec does not declare it
  template <class T>
  [[nodiscard]] std::shared_ptr<LoopReader<T>> loop_input(const topics::Topic<T>& topic) {
    declared_read(topic.description);
    auto reader = std::make_shared<LoopReader<T>>(topic, bus_.subscriber(topic, loop_endpoint(clock_)));
    loop_inputs_.push_back(reader);
    return reader;
  }
  /// Any other topic. @throws std::logic_error when the spec does not declare it
  template <class T>
  [[nodiscard]] bus::Subscriber<T> input(const topics::Topic<T>& topic) {
    declared_read(topic.description);
    return bus_.subscriber(topic);
  }
  /// @throws std::logic_error when the spec does not declare it, or the spec's source may not write it
  template <class T>
  [[nodiscard]] Output<T> output(const topics::Topic<T>& topic) {
    const bool awaited = declared_write(topic.description);
    const auto options = topic.description.every_tick ? loop_endpoint(clock_) : bus::EndpointOptions{};
    auto publisher = std::make_shared<bus::Publisher<T>>(bus_.publisher(topic, options));
    if (awaited) readers_.emplace_back([publisher] { return publisher->matched(); });
    return {std::move(publisher), refused_};
  }

  /// @throws std::logic_error naming what the spec declares and the component has not made
  void require_complete() const;
  /// Every loop input has a writer, every output that needs one a reader.
  [[nodiscard]] bool connected() const;
  /// Looks for second writers that are silent. Call once per tick.
  void watch(std::int64_t now_ns);
  /// A topic this component reads has had a second writer within the last second.
  [[nodiscard]] bool disputed(std::int64_t now_ns) const;
  /// "crane/command: a writer that calls itself supervisor, start-up number 4711"; empty while nothing is
  /// disputed.
  [[nodiscard]] std::string dispute(std::int64_t now_ns) const;
  [[nodiscard]] std::uint64_t foreign() const;                       ///< samples of other writers, dropped
  [[nodiscard]] std::uint64_t rejected() const;                      ///< samples with a wrong CRC, dropped
  [[nodiscard]] std::uint64_t refused() const { return *refused_; }  ///< samples the vendor did not send

 private:
  void declared_read(const topics::Description& topic);
  bool declared_write(const topics::Description& topic);

  bus::Bus& bus_;
  const ComponentSpec& spec_;
  const control::Controller& controller_;
  Clock clock_;
  std::vector<std::shared_ptr<LoopInput>> loop_inputs_;
  std::vector<std::function<int()>> readers_;  ///< of outputs that need one
  std::shared_ptr<std::uint64_t> refused_ = std::make_shared<std::uint64_t>(0);
  std::vector<const topics::Description*> made_;
};

}  // namespace crane::runtime
