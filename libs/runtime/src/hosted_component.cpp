#include "crane/runtime/hosted_component.hpp"

namespace crane::runtime {

HostedComponent::HostedComponent(bus::Bus& bus, const ComponentSpec& spec, const configuration::Rig& rig,
                                 const control::Controller& controller, Clock clock,
                                 std::int64_t (*monotonic_ns)())
    : spec_{spec},
      node_{bus,
            {std::string{spec.name}, spec.runs_controller ? std::string{controller.name} : "",
             configuration::digest(rig, controller.name)}},
      ports_{bus, spec_, controller, rig.design, clock},
      component_{spec_.make(Context{ports_, node_, rig, controller, bus.options(), clock, monotonic_ns})} {
  ports_.require_complete();
}

}  // namespace crane::runtime
