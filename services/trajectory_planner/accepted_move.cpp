#include "trajectory_planner/accepted_move.hpp"

#include <iterator>

namespace crane::services {

MoveTarget target_of(const msg::AcceptedMove& request) {
  MoveTarget move;
  for (std::size_t i = 0; i < control::kAxes; ++i) {
    move.selected[i] = request.selected[i];
    move.target[i] = request.target[i];
  }
  return move;
}

control::Excitation excitation_of(const msg::AcceptedMove& request) {
  control::Excitation excitation;
  while (excitation.axis + 1 < control::kAxes && !request.selected[excitation.axis]) ++excitation.axis;
  excitation.mean_position = request.target[excitation.axis];
  for (std::size_t i = 0; i < excitation.sines.size(); ++i)
    excitation.sines[i] = {request.sine[i].amplitude, request.sine[i].frequency_hz,
                           request.sine[i].phase_rad};
  excitation.duration_s = request.duration_s;
  return excitation;
}

bool is_inside_limits(const configuration::Rig& rig, const msg::AcceptedMove& move) {
  for (std::size_t i = 0; i < control::kAxes; ++i) {
    const auto& drive = rig.drives[i];
    if (move.selected[i] && !(move.target[i] >= drive.low_limit && move.target[i] <= drive.high_limit))
      return false;
  }
  return true;
}

}  // namespace crane::services
