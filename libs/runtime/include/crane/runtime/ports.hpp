#pragma once
/// Creates the endpoints of one component. Only endpoints that the ComponentSpec declares are permitted.
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
  realtime,  ///< the clock master follows CLOCK_MONOTONIC; a late process loses the tick
  lockstep,  ///< the plant starts tick k+1 after command k; no process can be late, and runs are reproducible
             ///< bit for bit
  /// replay of a real-time run: the runner delivers the recorded samples. The second poll() after a
  /// state finishes the tick of this state without the missing inputs. A poll() after the last step
  /// and without a new state makes the supervisor step without a state
  prescribed
};

/// Endpoint options of loop topics. In lockstep a process that joins late must receive every tick from the
/// first one; in real time it must receive new samples only.
[[nodiscard]] inline bus::EndpointOptions loop_endpoint(Clock clock) {
  bus::EndpointOptions endpoint;
  endpoint.history = clock == Clock::lockstep;
  return endpoint;
}

/// One output. Node reports the number of samples that the middleware did not send (node.hpp).
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
  /// All arguments must outlive the ports.
  Ports(bus::Bus& bus, const ComponentSpec& spec, const control::Controller& controller,
        const control::Design& design, Clock clock)
      : bus_{bus}, spec_{spec}, controller_{controller}, design_{design}, clock_{clock} {}

  /// Reader of a loop topic. @throws std::logic_error when the spec does not declare the topic in `reads`
  template <class T>
  [[nodiscard]] std::shared_ptr<LoopReader<T>> loop_input(const topics::Topic<T>& topic) {
    declared_read(topic.description);
    auto reader = std::make_shared<LoopReader<T>>(topic, bus_.subscriber(topic, loop_endpoint(clock_)));
    loop_inputs_.push_back(reader);
    return reader;
  }
  /// Reader of any other topic. @throws std::logic_error when the spec does not declare the topic in `reads`
  template <class T>
  [[nodiscard]] bus::Subscriber<T> input(const topics::Topic<T>& topic) {
    declared_read(topic.description);
    return bus_.subscriber(topic);
  }
  /// Writer of a topic. @throws std::logic_error when the spec does not declare the topic in `writes`, or
  ///   when the source of the spec may not write the topic
  template <class T>
  [[nodiscard]] Output<T> output(const topics::Topic<T>& topic) {
    const bool awaited = declared_write(topic.description);
    const auto options = topic.description.every_tick ? loop_endpoint(clock_) : bus::EndpointOptions{};
    auto publisher = std::make_shared<bus::Publisher<T>>(bus_.publisher(topic, options));
    if (awaited) readers_.emplace_back([publisher] { return publisher->matched(); });
    return {std::move(publisher), refused_};
  }

  /// @throws std::logic_error with the name of an endpoint that the spec declares and the component has not
  ///   created
  void require_complete() const;
  /// @return true when every loop input has a writer and every output that needs a reader has one
  [[nodiscard]] bool connected() const;
  /// Detects second writers that are matched and have sent no sample. Call once per tick.
  void watch(std::int64_t now_ns);
  /// @return true when a topic that this component reads has had a second writer within the last second
  [[nodiscard]] bool disputed(std::int64_t now_ns) const;
  /// @return for each topic with a second writer its name and WriterBinding::dispute(); empty when there is
  ///   none
  [[nodiscard]] std::string dispute(std::int64_t now_ns) const;
  [[nodiscard]] std::uint64_t foreign() const;                       ///< dropped: samples of a second writer
  [[nodiscard]] std::uint64_t rejected() const;                      ///< dropped: samples with a wrong CRC
  [[nodiscard]] std::uint64_t refused() const { return *refused_; }  ///< samples that were not sent

 private:
  void declared_read(const topics::Description& topic);
  bool declared_write(const topics::Description& topic);

  bus::Bus& bus_;
  const ComponentSpec& spec_;
  const control::Controller& controller_;
  const control::Design& design_;
  Clock clock_;
  std::vector<std::shared_ptr<LoopInput>> loop_inputs_;
  std::vector<std::function<int()>> readers_;  ///< number of readers of each output that needs a reader
  std::shared_ptr<std::uint64_t> refused_ = std::make_shared<std::uint64_t>(0);
  std::vector<const topics::Description*> made_;
};

}  // namespace crane::runtime
