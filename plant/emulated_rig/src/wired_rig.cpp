#include "crane/emulated_rig/wired_rig.hpp"

#include "crane/boards/shared_lines.hpp"
#include "crane/bridge/converter.hpp"
#include "crane/simulator/component.hpp"

namespace crane::emulated_rig {
namespace {

constexpr unsigned kFirstOutput = 16;

bool is_on(std::uint16_t levels, int output) {
  return (levels >> (static_cast<unsigned>(output) - kFirstOutput) & 1U) != 0;
}

}  // namespace

WiredRig::WiredRig(const configuration::Rig& rig)
    : encoders_{rig.encoders},
      drives_{rig.drives},
      wiring_{rig.wiring},
      crane_{simulator::simulated_rig_of(rig)},
      first_counts_{crane_.read().raw_counts} {}

std::int32_t WiredRig::pulses(std::size_t channel) noexcept {
  for (std::size_t i = 0; i < bridge::kCounters; ++i)
    if (encoders_[i].counts_per_unit > 0 && static_cast<std::size_t>(encoders_[i].channel) == channel)
      return crane_.read().raw_counts[i] - first_counts_[i];
  return 0;  // no encoder at this channel
}

/// A contact is closed, and its line low, in normal operation.
std::uint16_t WiredRig::inputs() noexcept {
  const auto state = crane_.read();
  unsigned levels = 0xFFFF;
  const auto close = [&levels](bool closed, int input) {
    if (closed) levels &= ~(1U << static_cast<unsigned>(input));
  };
  close(!state.estop_pressed, wiring_.estop_input);
  close(!state.watchdog_dropped, wiring_.relay_closed_input);
  for (std::size_t i = 0; i < bridge::kDrives; ++i) {
    if (!drives_[i].present) continue;
    close(!state.limit_low[i], wiring_.drives[i].limit_low_input);
    close(!state.limit_high[i], wiring_.drives[i].limit_high_input);
    close(state.brake_closed[i], wiring_.drives[i].brake_closed_input);
    if (wiring_.drives[i].mark_input >= 0) close(state.mark[i], wiring_.drives[i].mark_input);
  }
  return static_cast<std::uint16_t>(levels);
}

void WiredRig::set_converter(std::size_t channel, std::uint16_t code) noexcept {
  for (std::size_t i = 0; i < bridge::kDrives; ++i)
    if (drives_[i].present && static_cast<std::size_t>(drives_[i].dac_channel) == channel)
      outputs_.drive_v[i] = bridge::converter_voltage_v(code);
  changed_ = true;
}

void WiredRig::set_outputs(std::uint16_t levels) noexcept {
  for (std::size_t i = 0; i < bridge::kDrives; ++i)
    outputs_.brake_release[i] =
        drives_[i].present && (is_on(levels, wiring_.drives[i].brake_release_output) ||
                               (outputs_.brake_release[i] && (faults_ & bridge::kStuckBrakeOutputs) != 0));
  outputs_.watchdog_level = is_on(levels, wiring_.watchdog_output);
  changed_ = true;
}

/// Writes the changes of several lines together: the command terms of the model act once per tick.
void WiredRig::advance_to(std::int64_t time_ns) {
  if ((faults_ & bridge::kWeldedRelay) != 0) {
    // Continuous toggles keep the simulated relay closed, like welded contacts.
    outputs_.watchdog_level = !outputs_.watchdog_level;
    changed_ = true;
  }
  if (changed_) crane_.write(outputs_);
  changed_ = false;
  crane_.advance_to(time_ns);
}

}  // namespace crane::emulated_rig
