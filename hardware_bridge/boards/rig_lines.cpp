#include "crane/boards/rig_lines.hpp"

namespace crane::bridge {
namespace {

constexpr std::uint32_t bit_of(int line) { return std::uint32_t{1} << static_cast<unsigned>(line); }

}  // namespace

RigLines::RigLines(const configuration::Rig& rig) : wiring_{rig.wiring} {
  for (std::size_t i = 0; i < kDrives; ++i) present_[i] = rig.drives[i].present;
}

void RigLines::read(std::uint32_t levels, Inputs& inputs) const noexcept {
  const auto closed = [levels](int line) { return (levels & bit_of(line)) == 0; };
  for (std::size_t i = 0; i < kDrives; ++i) {
    const auto& lines = wiring_.drives[i];
    inputs.limit_low[i] = present_[i] && !closed(lines.limit_low_input);
    inputs.limit_high[i] = present_[i] && !closed(lines.limit_high_input);
    inputs.brake_closed[i] = !present_[i] || closed(lines.brake_closed_input);
    inputs.mark[i] = present_[i] && lines.mark_input >= 0 && closed(lines.mark_input);
  }
  inputs.estop_pressed = !closed(wiring_.estop_input);
  inputs.watchdog_dropped = !closed(wiring_.relay_closed_input);
}

std::uint32_t RigLines::outputs(const Outputs& outputs) const noexcept {
  std::uint32_t levels = outputs.watchdog_level ? bit_of(wiring_.watchdog_output) : 0;
  for (std::size_t i = 0; i < kDrives; ++i)
    if (present_[i] && outputs.brake_release[i]) levels |= bit_of(wiring_.drives[i].brake_release_output);
  return levels;
}

}  // namespace crane::bridge
