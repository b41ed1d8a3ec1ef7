#include "cli/measured_stack.hpp"

#include <unistd.h>

#include "cli/number_range.hpp"
#include "stack/data_files.hpp"
#include "stack/stack.hpp"

namespace crane::cli {

std::vector<runtime::ComponentSpec> MeasuredStack::processes() const {
  return hardware() ? stack::hardware_stack() : stack::simulated_stack();
}

void MeasuredStack::prepare() {
  launch.rig = stack::find_rig(rig).string();
  launch.bus.crane = "bench_" + std::to_string(::getpid());
}

void add_measured_stack(CLI::App& command, MeasuredStack& options, double longest_s) {
  command.add_option("--rig", options.rig, "rig file or name")->capture_default_str();
  command
      .add_option("--plant", options.plant,
                  "hardware: the bridge with the board of the rig file; sim: the simulated plant")
      ->check(CLI::IsMember({"hardware", "sim"}))
      ->capture_default_str();
  command.add_option("--seconds", options.seconds, "duration in s")
      ->check(number_in(1.0, longest_s))
      ->capture_default_str();
  command.add_flag("--json", options.json, "print as JSON");
  runtime::add_bus_options(command, options.launch.bus);
}

}  // namespace crane::cli
