/// crane hw: bring-up of a rig without a stack.
#include <CLI/CLI.hpp>

#include "cli/commands/hw_commands.hpp"

namespace crane::cli {

void add_hw(CLI::App& app, Action& chosen) {
  auto* hw =
      app.add_subcommand("hw", "Test wiring and calibration of a new rig, before its first use with a stack");
  hw->require_subcommand(1);
  hw->footer(
      "Required: no stack runs, and a person stands at the emergency stop.\n"
      "Order: probe, selftest, calibrate, selftest with the calibrated file (docs/hardware.md).\n"
      "Every command leaves the board at 0 V with closed brakes, also after Ctrl-C.\n"
      "To rehearse: crane hw selftest --rig emulated_servo_to_go");
  add_hw_list(*hw, chosen);
  add_hw_probe(*hw, chosen);
  add_hw_selftest(*hw, chosen);
  add_hw_jog(*hw, chosen);
  add_hw_calibrate(*hw, chosen);
}

}  // namespace crane::cli
