#include "stack/stack.hpp"

#include "anti_swing/anti_swing.hpp"
#include "crane/emulated_rig/component.hpp"
#include "crane/simulator/component.hpp"
#include "crane/supervisor/component.hpp"
#include "friction_compensation/friction_compensation.hpp"
#include "tracking/tracking.hpp"
#include "trajectory_planner/trajectory_planner.hpp"

namespace crane::stack {

namespace {

std::vector<runtime::ComponentSpec> stack_behind(const runtime::ComponentSpec& clock_master) {
  return {clock_master,
          services::trajectory_planner_spec(),
          services::tracking_spec(),
          services::anti_swing_spec(),
          services::friction_compensation_spec(),
          supervisor::supervisor_spec()};
}

}  // namespace

std::vector<runtime::ComponentSpec> simulated_stack() {
  return stack_behind(simulator::simulated_plant_spec());
}

std::vector<runtime::ComponentSpec> hardware_stack() {
  return stack_behind(emulated_rig::hardware_bridge_spec());
}

std::vector<runtime::ComponentSpec> stack_with(Plant plant) {
  return plant == Plant::hardware ? hardware_stack() : simulated_stack();
}

}  // namespace crane::stack
