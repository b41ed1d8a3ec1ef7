/// crane hw: bring-up of a rig without a stack.
#include <CLI/CLI.hpp>

#include "cli/commands/hw_commands.hpp"

namespace crane::cli {

void add_hw(CLI::App& app, Action& chosen) {
  auto* hw = app.add_subcommand("hw", "Bring up a rig: inspect, jog, calibrate, test the wiring");
  hw->require_subcommand(1);
  hw->footer(
      "Order, without a stack and with a person at the emergency stop: probe, selftest, calibrate, selftest "
      "with the\n"
      "calibrated file (docs/hardware.md). Every command leaves the board at 0 V with closed brakes, Ctrl-C "
      "too.\n"
      "To rehearse: crane hw selftest --rig emulated_servo_to_go");
  add_hw_list(*hw, chosen);
  add_hw_probe(*hw, chosen);
  add_hw_selftest(*hw, chosen);
  add_hw_jog(*hw, chosen);
  add_hw_calibrate(*hw, chosen);
}

}  // namespace crane::cli
