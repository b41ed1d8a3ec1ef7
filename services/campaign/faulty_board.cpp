#include "campaign/faulty_board.hpp"

#include <cmath>

#include "crane/bridge/converter.hpp"
#include "crane/simulator/component.hpp"

namespace crane::campaign {

FaultyRig::FaultyRig(const configuration::Rig& configured, const configuration::Rig& actual)
    : configured_{configured}, board_{simulator::simulated_rig_of(actual)} {}

bridge::Inputs FaultyRig::read() {
  auto inputs = board_.read();
  const auto true_counts = inputs.raw_counts;
  if (change_inputs) change_inputs(inputs);
  for (std::size_t i = 0; i < bridge::kCounters; ++i) {
    const double counts = configured_.encoders[i].counts_per_unit;
    const auto error = simulator::wrap_24_bit(std::int64_t{inputs.raw_counts[i]} - true_counts[i]);
    shown_error_[i] = counts > 0 ? std::abs(static_cast<double>(error)) / counts : 0;
  }
  return inputs;
}

std::array<double, bridge::kDrives> FaultyRig::write(const bridge::Outputs& outputs) {
  written_ = outputs;
  auto given = outputs;
  if (change_outputs) change_outputs(given);
  board_.write(given);
  std::array<double, bridge::kDrives> reported_v{};  // the bridge cannot read the outputs of its converters
  for (std::size_t i = 0; i < reported_v.size(); ++i)
    reported_v[i] = bridge::converter_voltage_v(bridge::converter_code(outputs.drive_v[i]));
  return reported_v;
}

void FaultyRig::make_safe() noexcept {
  written_ = {};
  board_.make_safe();
}

double FaultyRig::output_error_v(std::size_t axis) {
  return std::abs(board_.converter_v()[axis] - written_.drive_v[axis]);
}

Truth FaultyRig::truth() {
  const auto& state = board_.truth();
  Truth truth{.swing_radial_rad = state.radial_rad, .swing_tangential_rad = state.tangential_rad};
  const auto inputs = board_.read();
  for (std::size_t i = 0; i < kAxes; ++i) {
    const auto axis = static_cast<plant::Axis>(i);
    truth.position[i] = plant::position(state, axis);
    truth.speed[i] = plant::speed(state, axis);
    truth.converter_v[i] = board_.converter_v()[i] * configured_.drives[i].sign;
    truth.written_v[i] = written_.drive_v[i] * configured_.drives[i].sign;
    truth.brake_closed[i] = inputs.brake_closed[i];
    truth.brake_release[i] = written_.brake_release[i];
  }
  return truth;
}

}  // namespace crane::campaign
