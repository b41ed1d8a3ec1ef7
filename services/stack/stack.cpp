#include "stack/stack.hpp"

#include "anti_swing/anti_swing.hpp"
#include "friction_compensation/friction_compensation.hpp"
#include "process/simulated_plant.hpp"
#include "process/supervisor_component.hpp"
#include "tracking/tracking.hpp"
#include "trajectory_planner/trajectory_planner.hpp"

namespace crane::stack {

std::vector<runtime::ComponentSpec> simulated_stack() {
  return {simulator::simulated_plant_spec(),
          services::trajectory_planner_spec(),
          services::tracking_spec(),
          services::anti_swing_spec(),
          services::friction_compensation_spec(),
          supervisor::supervisor_spec()};
}

}  // namespace crane::stack
