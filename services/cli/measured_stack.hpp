#pragma once
/// Options of the measurements of `crane bench` that run a stack of their own in real time.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "crane/runtime/wiring.hpp"
#include "stack/launch.hpp"
#include "stack/stack.hpp"

namespace crane::cli {

struct MeasuredStack {
  stack::LaunchOptions launch;
  std::string rig = "emulated_servo_to_go";  ///< file or name
  stack::Plant plant = stack::Plant::hardware;
  double seconds = 20;
  bool json = false;

  /// Whether the bridge runs with the board of the rig file instead of the simulated plant.
  [[nodiscard]] bool hardware() const { return plant == stack::Plant::hardware; }
  [[nodiscard]] std::vector<runtime::ComponentSpec> processes() const;
  /// Finds the rig file, and gives the crane a name that no other process has.
  /// @throws configuration::ConfigurationError when there is no such rig file
  void prepare();
};

/// Adds --rig, --plant, --seconds, --json and the options of the bus.
/// @param options  must outlive the command
void add_measured_stack(CLI::App& command, MeasuredStack& options, double longest_s);

}  // namespace crane::cli
