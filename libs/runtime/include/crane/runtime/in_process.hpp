#pragma once
/// A whole stack in one process over the memory bus: for tests, campaigns and Monte Carlo. Lockstep only;
/// gives the same recording as the stack of processes, bit for bit.
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
  /// One more component, with a rig file of its own. Both must outlive the stack.
  void add(const ComponentSpec& spec, const configuration::Rig& rig, const control::Controller& controller);

  /// The network the components talk over, for an operator's or recorder's own Bus.
  [[nodiscard]] const std::shared_ptr<bus::MemoryNetwork>& network() const { return network_; }
  /// Lets every component do what it can until all of them wait. @return true when anybody did something
  bool pump();
  /// One line per component: what it waits for.
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

/// Options of a Bus on `network`.
[[nodiscard]] bus::Options memory_options(std::shared_ptr<bus::MemoryNetwork> network,
                                          std::string participant, crane_Source source);

}  // namespace crane::runtime
