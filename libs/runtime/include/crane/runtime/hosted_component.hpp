#pragma once
/// A component with its node and its ports. Both runners (component.hpp) use it.
#include <memory>

#include "crane/runtime/component.hpp"
#include "crane/runtime/node.hpp"

namespace crane::runtime {

class HostedComponent {
 public:
  /// Builds the component of `spec`. `bus`, `rig` and `controller` must outlive it.
  /// @param monotonic_ns  see Context
  /// @throws std::logic_error when the endpoints of the component differ from those that `spec` declares
  HostedComponent(bus::Bus& bus, const ComponentSpec& spec, const configuration::Rig& rig,
                  const control::Controller& controller, Clock clock,
                  std::int64_t (*monotonic_ns)() = nullptr);
  [[nodiscard]] Component& component() { return *component_; }
  [[nodiscard]] Node& node() { return node_; }
  [[nodiscard]] const Ports& ports() const { return ports_; }

 private:
  ComponentSpec spec_;
  Node node_;
  Ports ports_;
  std::unique_ptr<Component> component_;
};

}  // namespace crane::runtime
