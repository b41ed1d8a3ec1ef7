/// crane bench tick: breakdown of the latency of a tick, from the latched state to the arrival of its
/// command, beside the floors of the same run.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands/bench.hpp"
#include "cli/floors.hpp"
#include "cli/measured_stack.hpp"
#include "cli/processor_time.hpp"
#include "cli/tick_report.hpp"
#include "crane/bus/cdr.hpp"
#include "crane/bus/seal.hpp"
#include "experiments/realtime_session.hpp"
#include "observation/arrival_statistics.hpp"
#include "stack/launch.hpp"

namespace crane::cli {
namespace {

using namespace std::chrono_literals;

/// Mean time of a call in ns, of the fastest batch, because other programs delay some batches.
template <class Work>
double call_ns(const Work& work) {
  constexpr int kBatches = 50, kCalls = 200;
  double least_ns = std::numeric_limits<double>::infinity();
  for (int batch = 0; batch < kBatches; ++batch) {
    const auto begin_ns = runtime::monotonic_ns();
    for (int i = 0; i < kCalls; ++i) work();
    least_ns = std::min(least_ns, static_cast<double>(runtime::monotonic_ns() - begin_ns) / kCalls);
  }
  return least_ns;
}

/// Share of the encoding in the sealing (encoding and CRC) of a sample, by topic. Measured with the code and
/// the types of the loop.
std::array<double, topics::kAll.size()> codec_shares() {
  std::array<double, topics::kAll.size()> shares{};
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const auto& topic = topics::kAll[i];
    const auto& codec = bus::CdrCodec::of(*topic.descriptor);
    std::vector<std::uint64_t> sample(codec.sample_bytes() / 8 + 1);
    std::vector<std::uint8_t> bytes(codec.max_encoded_bytes());
    std::size_t encoded = 0;
    const auto codec_ns = call_ns([&] { encoded += codec.encode(sample.data(), bytes); });
    const auto seal_ns = call_ns([&] { bus::seal(topic, sample.data(), crane_SOURCE_PLANT, 1); });
    shares[i] = encoded > 0 ? std::min(codec_ns / seal_ns, 1.0) : 0;
  }
  return shares;
}

/// The clock stamps of all processes of a stack.
class Stamps {
 public:
  explicit Stamps(std::size_t processes) : readers_(processes) {}
  /// Starts the processes, each with the file of its stamps.
  void launch(stack::ChildProcesses& children, const std::vector<runtime::ComponentSpec>& specs,
              const stack::LaunchOptions& options) const {
    for (std::size_t i = 0; i < specs.size(); ++i) {
      ::setenv(bus::kStampsVariable, readers_[i].file().c_str(), 1);
      stack::launch(children, {specs[i]}, options);
    }
    ::unsetenv(bus::kStampsVariable);
  }
  const std::vector<std::vector<bus::PathRecord>>& take() {
    records_.resize(readers_.size());
    for (std::size_t i = 0; i < readers_.size(); ++i) readers_[i].take(records_[i]);
    return records_;
  }
  void forget() { records_.clear(); }

 private:
  std::vector<bus::PathStampReader> readers_;
  std::vector<std::vector<bus::PathRecord>> records_;
};

/// Lets the stack run. @throws std::runtime_error when a process ends
void collect(stack::ChildProcesses& children, Stamps& stamps, double seconds) {
  const auto end_ns = runtime::monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
  while (!runtime::stop_requested() && runtime::monotonic_ns() < end_ns) {
    ::usleep(50'000);
    stamps.take();
    if (const auto ended = children.ended()) throw std::runtime_error(stack::describe(*ended));
  }
}

TickBench measure(const MeasuredStack& options) {
  const auto rig = configuration::load_rig(options.launch.rig);
  TickBench bench{.processes = options.processes(),
                  .period_s = rig.period_s,
                  .priority = options.launch.priority,
                  .floors = {},
                  .processor = {},
                  .breakdown = {}};
  Floors floors{{.bus = options.launch.bus,
                 .period_ns = static_cast<std::int64_t>(rig.period_s * 1e9),
                 .ticks = static_cast<std::size_t>(options.seconds / rig.period_s) + 1,
                 .priority = options.launch.priority}};
  Stamps stamps{bench.processes.size()};
  stack::ChildProcesses children;
  if (options.hardware()) stack::launch_rig(children, rig, options.launch);
  stamps.launch(children, bench.processes, options.launch);
  {
    bus::Bus bus{runtime::bus_options(options.launch.bus, "crane_bench", crane_SOURCE_OPERATOR, 0)};
    stack::wait_until_ready(children, bench.processes, bus, 15s);
  }  // ends the observer, which would use processor time during the measurement
  floors.wait_until_ready(15s);
  constexpr double kSettle_s = 0.5;  // not measured: discovery and start-up
  collect(children, stamps, kSettle_s);
  const auto& states = stamps.take().front();
  if (states.empty()) throw std::runtime_error("no tick within 0.5 s; check the load of this computer");
  const auto tick_ns = states.back().sample_time_ns;
  stamps.forget();
  floors.begin(tick_ns);
  const ProcessorTimes processor{children, bench.processes};
  const auto begin_ns = runtime::monotonic_ns();
  collect(children, stamps, options.seconds);
  bench.processor =
      processor.per_tick(static_cast<double>(runtime::monotonic_ns() - begin_ns) * 1e-9 / rig.period_s);
  const auto& records = stamps.take();
  bench.floors = floors.finish();
  Isolated isolated{.codec_share = codec_shares(), .udp_hop_ns = 0};
  for (const auto& floor : bench.floors)
    if (floor.name == "udp_chain")
      isolated.udp_hop_ns = static_cast<std::int64_t>(observation::spread(floor.times_us)->p50 * 1e3 / 4);
  bench.breakdown = break_down(bench.processes, records, isolated);
  if (bench.breakdown.ticks.empty()) throw std::runtime_error("no tick has passed all processes");
  return bench;
}

int bench_tick(MeasuredStack options) {
  runtime::install_stop_signals();
  options.prepare();
  const auto bench = measure(options);
  if (options.json)
    std::cout << json_of(bench).dump(2) << '\n';
  else
    print(bench, std::cout);
  return runtime::kExitDone;
}

}  // namespace

void add_bench_tick(CLI::App& bench, Action& chosen) {
  auto options = std::make_shared<MeasuredStack>();
  auto* command = bench.add_subcommand(
      "tick",
      "Split the latency from state to command into hops and parts, and compare it with chains of raw UDP, "
      "Cyclone DDS and Fast DDS in the same run");
  add_measured_stack(*command, *options, 3600.0);
  command
      ->add_option("--priority", options->launch.priority,
                   "SCHED_FIFO priority of stack and floors, 0: ordinary scheduling")
      ->check(CLI::Range(0, 98))
      ->capture_default_str();
  command->footer(
      "Example: crane bench tick --seconds 60\n"
      "docs/benchmarks.md explains the parts. The floors use the next DDS domain on the loop-back.");
  command->callback([options, &chosen] { chosen = [options] { return bench_tick(*options); }; });
}

}  // namespace crane::cli
