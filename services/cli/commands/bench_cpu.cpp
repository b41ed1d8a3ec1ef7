/// crane bench cpu: processor time per tick of each process of the stack, for its loop and for the threads of
/// its DDS implementation.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands/bench.hpp"
#include "cli/measured_stack.hpp"
#include "cli/processor_time.hpp"
#include "cli/text_table.hpp"
#include "experiments/realtime_session.hpp"
#include "stack/launch.hpp"

namespace crane::cli {
namespace {

/// Lets the stack run. @throws std::runtime_error when a process ends
void pass(stack::ChildProcesses& children, double seconds) {
  const auto end_ns = runtime::monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
  while (!runtime::stop_requested() && runtime::monotonic_ns() < end_ns) {
    ::usleep(50'000);
    if (const auto ended = children.ended()) throw std::runtime_error(stack::describe(*ended));
  }
}

std::vector<ProcessShare> measure(const MeasuredStack& options) {
  const auto rig = configuration::load_rig(options.launch.rig);
  const auto specs = options.processes();
  stack::ChildProcesses children;
  if (options.hardware()) stack::launch_rig(children, rig, options.launch);
  stack::launch(children, specs, options.launch);
  {
    bus::Bus bus{runtime::bus_options(options.launch.bus, "crane_bench", crane_SOURCE_OPERATOR, 0)};
    stack::wait_until_ready(children, specs, bus, std::chrono::seconds{15});
  }  // ends the observer, which would use processor time during the measurement
  const ProcessorTimes processor{children, specs};
  const auto begin_ns = runtime::monotonic_ns();
  pass(children, options.seconds);
  return processor.per_tick(static_cast<double>(runtime::monotonic_ns() - begin_ns) * 1e-9 / rig.period_s);
}

int bench_cpu(MeasuredStack options) {
  runtime::install_stop_signals();
  options.prepare();
  auto json = nlohmann::ordered_json::array();
  TextTable table{{"process", "loop us/tick", "DDS threads us/tick", "together"}};
  for (const auto& share : measure(options)) {
    const auto loop_us = share.loop.running_us, dds_threads_us = share.others.running_us;
    json.push_back({{"process", share.process}, {"loop_us", loop_us}, {"dds_threads_us", dds_threads_us}});
    table.add(
        {share.process, fixed(loop_us, 1), fixed(dds_threads_us, 1), fixed(loop_us + dds_threads_us, 1)});
  }
  if (options.json)
    std::cout << json.dump(2) << '\n';
  else
    table.print(std::cout);
  return runtime::kExitDone;
}

}  // namespace

void add_bench_cpu(CLI::App& bench, Action& chosen) {
  auto options = std::make_shared<MeasuredStack>();
  auto* command = bench.add_subcommand(
      "cpu", "Measure the processor time per tick of each process (loop and DDS threads) in real time");
  add_measured_stack(*command, *options, 86400.0);
  command->footer("Example: crane bench cpu --seconds 20\nOther load on the computer increases the result.");
  command->callback([options, &chosen] { chosen = [options] { return bench_cpu(*options); }; });
}

}  // namespace crane::cli
