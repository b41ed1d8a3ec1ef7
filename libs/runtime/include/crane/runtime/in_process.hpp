#pragma once
/// A whole stack in one process over the memory bus, for tests and for large numbers of runs. Lockstep only.
/// Its recording equals, bit for bit, the recording of a stack of separate processes.
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "crane/runtime/hosted_component.hpp"

namespace crane::runtime {

class InProcessStack {
 public:
  /// Builds every component of `specs`. `rig` and `controller` must outlive the stack.
  InProcessStack(std::span<const ComponentSpec> specs, const configuration::Rig& rig,
                 const control::Controller& controller);
  /// Adds a component that uses another rig file. `rig` and `controller` must outlive the stack.
  void add(const ComponentSpec& spec, const configuration::Rig& rig, const control::Controller& controller);

  /// The network of the components, for the Bus of an operator or a recorder.
  [[nodiscard]] const std::shared_ptr<bus::MemoryNetwork>& network() const { return network_; }
  /// Polls all components repeatedly until every component waits for input. @return true when a component has
  /// processed something
  bool pump();
  /// One line per component with its missing inputs.
  [[nodiscard]] std::string waiting_for() const;
  [[nodiscard]] Component& component(std::size_t index) { return rooms_.at(index).hosted->component(); }

 private:
  struct Room {
    std::unique_ptr<bus::Bus> bus;
    std::unique_ptr<HostedComponent> hosted;
  };
  std::shared_ptr<bus::MemoryNetwork> network_;
  std::vector<Room> rooms_;
};

/// Options for a Bus on `network`.
[[nodiscard]] bus::Options memory_options(std::shared_ptr<bus::MemoryNetwork> network,
                                          std::string participant, crane_Source source);

}  // namespace crane::runtime
