#pragma once
/// All components of a stack in one process. In lockstep, the components communicate over the memory bus; the
/// recording equals, bit for bit, that of a stack of separate processes. In real time, the components
/// communicate over DDS, so that other programs receive every topic (loop_process.hpp).
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "crane/runtime/hosted_component.hpp"

namespace crane::runtime {

/// Creates the bus of one component.
using BusOf = std::function<bus::Bus(const ComponentSpec&)>;

class InProcessStack {
 public:
  /// Lockstep: builds every component of `specs` on a new memory network. `rig` and `controller` must outlive
  /// the stack.
  InProcessStack(std::span<const ComponentSpec> specs, const configuration::Rig& rig,
                 const control::Controller& controller);
  /// Real time: builds every component of `specs` on the bus that `bus_of` creates for it.
  InProcessStack(std::span<const ComponentSpec> specs, const configuration::Rig& rig,
                 const control::Controller& controller, const BusOf& bus_of);
  /// Lockstep: adds a component that uses another rig file. `rig` and `controller` must outlive the stack.
  void add(const ComponentSpec& spec, const configuration::Rig& rig, const control::Controller& controller);

  /// Lockstep: the network of the components, for the Bus of an operator or a recorder.
  [[nodiscard]] const std::shared_ptr<bus::MemoryNetwork>& network() const { return network_; }
  /// Polls the components until all of them wait for input. @return true when a component has processed
  /// something
  bool pump();
  /// Real time: sleeps until a sample arrives, or until a component must be polled without a new sample, at
  /// most until `latest_ns`.
  void wait(std::int64_t latest_ns);
  /// @return one line per component: its name and the inputs for which it waits
  [[nodiscard]] std::string waiting_for() const;
  [[nodiscard]] Component& component(std::size_t index) { return entries_.at(index).hosted->component(); }
  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] Node& node(std::size_t index) { return entries_.at(index).hosted->node(); }

 private:
  struct Entry {
    explicit Entry(bus::Bus own) : bus{std::move(own)} {}
    std::atomic<bool> has_samples = false;  ///< real time: a sample has arrived since the last poll
    bus::Bus bus;
    std::unique_ptr<HostedComponent> hosted;
  };
  void add(const ComponentSpec& spec, const configuration::Rig& rig, const control::Controller& controller,
           bus::Bus bus, Clock clock);
  void arrived(Entry& entry);

  std::shared_ptr<bus::MemoryNetwork> network_;  ///< null in real time
  std::mutex mutex_;                             ///< protects arrived_
  std::condition_variable arrival_;
  bool arrived_ = false;  ///< a sample has arrived since the last pass of pump()
  std::deque<Entry> entries_;
};

/// Options for a Bus on `network`.
[[nodiscard]] bus::Options memory_options(std::shared_ptr<bus::MemoryNetwork> network,
                                          std::string participant, crane_Source source);

}  // namespace crane::runtime
