#include "dashboard/hold.hpp"

#include <algorithm>
#include <cmath>

namespace crane::dashboard {

bool is_hold(const stack::OperatorRequest& wanted) {
  return wanted.kind == crane_REQUEST_MOVE &&
         std::ranges::none_of(wanted.selected, [](bool selected) { return selected; });
}

stack::OperatorRequest move_to_rest(const msg::State& state, const msg::SupervisorStatus& status,
                                    const std::array<double, 3>& reference_acceleration) {
  const std::array position{state.trolley_position_m, state.slew_angle_rad, state.cable_length_m},
      speed{state.trolley_speed_mps, state.slew_speed_radps, state.cable_speed_mps};
  const bool moving = status.move.number != 0;
  stack::OperatorRequest hold{.kind = crane_REQUEST_MOVE};
  for (std::size_t i = 0; i < position.size(); ++i) {
    hold.selected[i] = moving ? status.move.selected[i] : status.volt_limit_v[i] > 0;
    if (!hold.selected[i]) continue;
    const double acceleration = reference_acceleration[i];
    const double way = acceleration > 0 ? speed[i] * std::abs(speed[i]) / (2 * acceleration) : 0;
    hold.target[i] = position[i] + way;
  }
  return hold;
}

}  // namespace crane::dashboard
