#pragma once
/// One component on a memory bus, in lockstep or with a clock that the test sets. A test publishes the inputs
/// of the component, executes a step, and reads its outputs.
#include <map>
#include <memory>
#include <string>

#include "crane/configuration/rig.hpp"
#include "crane/runtime/hosted_component.hpp"
#include "crane/runtime/in_process.hpp"
#include "crane/runtime/process.hpp"

namespace crane::runtime::test {

class ComponentBench {
 public:
  /// @param controller  name of the registry; empty: the controller of the rig file
  ComponentBench(const ComponentSpec& spec, configuration::Rig rig, const std::string& controller = {},
                 Clock clock = Clock::lockstep)
      : rig_{std::move(rig)},
        controller_{chosen_controller(controller, rig_)},
        bus_{memory_options(network_, std::string{spec.program}, spec.source)},
        listener_{memory_options(network_, "listener", crane_SOURCE_OPERATOR)},
        hosted_{bus_, spec, rig_, controller_, clock} {}

  /// Publishes a sample as a process of kind `source`.
  template <class T>
  void publish(const topics::Topic<T>& topic, crane_Source source, const T& sample) {
    auto& bus = writers_.try_emplace(source, memory_options(network_, "writer", source)).first->second;
    auto& publisher = publishers_[std::string{topic.description.name}];
    if (!publisher)
      publisher = std::make_shared<bus::Publisher<T>>(bus.publisher(topic, loop_endpoint(Clock::lockstep)));
    if (!std::static_pointer_cast<bus::Publisher<T>>(publisher)->publish(sample))
      throw std::logic_error{"the memory bus refused a sample"};
  }
  /// Creates the reader.
  template <class T>
  [[nodiscard]] bus::Subscriber<T> listen(const topics::Topic<T>& topic) {
    return listener_.subscriber(topic);
  }
  /// Polls the component until it has no more work.
  void step() {
    while (hosted_.component().poll(now_ns_)) {
    }
  }
  /// Sets the clock forward, then steps.
  void step_after(std::int64_t time_ns) {
    now_ns_ += time_ns;
    step();
  }
  [[nodiscard]] const configuration::Rig& rig() const { return rig_; }
  [[nodiscard]] const control::Controller& controller() const { return controller_; }

 private:
  std::shared_ptr<bus::MemoryNetwork> network_ = bus::make_memory_network();
  configuration::Rig rig_;
  const control::Controller& controller_;
  bus::Bus bus_, listener_;
  HostedComponent hosted_;
  std::map<crane_Source, bus::Bus> writers_;
  std::map<std::string, std::shared_ptr<void>> publishers_;
  std::int64_t now_ns_ = 0;
};

/// Header of tick k of a rig with a period of 10 ms.
[[nodiscard]] inline msg::Header tick(std::uint64_t number) {
  return {.tick = number,
          .sample_time_ns = static_cast<std::int64_t>(number) * 10'000'000,
          .source = crane_SOURCE_NONE,
          .epoch = 0};
}

/// A tower crane at rest, the load displaced by `swing_rad` in both directions.
[[nodiscard]] inline msg::State state_at(std::uint64_t number, double swing_rad = 0) {
  msg::State state{};
  for (bool& known : state.position_known) known = true;
  state.header = tick(number);
  state.trolley_position_m = 0.5;
  state.slew_angle_rad = 0.2;
  state.cable_length_m = 1;
  state.swing_radial_rad = swing_rad;
  state.swing_tangential_rad = swing_rad;
  return state;
}

/// Reference at the positions of state_at(), with the trolley `ahead_m` farther out.
[[nodiscard]] inline msg::Reference reference_at(std::uint64_t number, double ahead_m = 0) {
  msg::Reference reference{};
  reference.header = tick(number);
  reference.axis[control::kTrolley].position = 0.5 + ahead_m;
  reference.axis[control::kSlew].position = 0.2;
  reference.axis[control::kHoist].position = 1;
  return reference;
}

[[nodiscard]] inline configuration::Rig tower() {
  return configuration::load_rig(std::string{CRANE_RIGS} + "/virginia_tech_tower.toml");
}

}  // namespace crane::runtime::test
