#include "cli/measured_stack.hpp"

#include <unistd.h>

#include "cli/number_range.hpp"
#include "cli/plant_option.hpp"
#include "stack/data_files.hpp"

namespace crane::cli {

std::vector<runtime::ComponentSpec> MeasuredStack::processes() const { return stack::stack_with(plant); }

void MeasuredStack::prepare() {
  launch.rig = stack::find_rig(rig).string();
  launch.bus.crane = "bench_" + std::to_string(::getpid());
}

void add_measured_stack(CLI::App& command, MeasuredStack& options, double longest_s) {
  command.add_option("--rig", options.rig, "rig file or name")->capture_default_str();
  add_plant_option(command, options.plant);
  command.add_option("--seconds", options.seconds, "duration in s")
      ->check(number_in(1.0, longest_s))
      ->capture_default_str();
  command.add_flag("--json", options.json, "print as JSON");
  runtime::add_bus_options(command, options.launch.bus);
}

}  // namespace crane::cli
