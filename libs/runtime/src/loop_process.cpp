#include "crane/runtime/loop_process.hpp"

#include "crane/bus/ledger.hpp"
#include "crane/configuration/encoder_resolution.hpp"
#include "crane/configuration/realtime_period.hpp"
#include "crane/runtime/in_process.hpp"
#include "crane/runtime/memory_limit.hpp"
#include "host.hpp"

namespace crane::runtime {
namespace {

void require_possible(const LoopOptions& options) {
  std::vector<std::string> problems;
  if (clock_from(options.clock) == Clock::lockstep)
    problems.push_back("--clock " + options.clock +
                       ": one process runs the loop in real time only; for lockstep use `crane run "
                       "--in-process`");
  if (!options.bus.secure.empty())
    problems.push_back("--secure " + options.bus.secure +
                       ": the roles of the components have different rights, and a participant has one role; "
                       "run each component in a process");
  if (!problems.empty()) throw configuration::ConfigurationError(std::move(problems));
}

std::vector<Write> writes_of(const std::vector<ComponentSpec>& specs) {
  std::vector<Write> writes;
  for (const auto& spec : specs) writes.insert(writes.end(), spec.writes.begin(), spec.writes.end());
  return writes;
}

int run_loop(const std::vector<ComponentSpec>& specs, const LoopOptions& options) {
  require_possible(options);
  const auto rig = configuration::load_rig(options.rig);
  configuration::require_realtime_period(rig);
  configuration::require_resolved_speeds(rig);
  const auto& controller = chosen_controller(options.controller, rig);
  const auto new_epoch = [&] { return options.epoch != 0 ? options.epoch : random_epoch(); };
  auto joining = bus_options(options.bus, std::string{kLoopProgram}, specs.front().source, new_epoch());
  joining.ledger = options.ledger.empty() ? bus::Ledger::create() : bus::Ledger::open(options.ledger);
  bus::Bus participant{std::move(joining)};
  refuse_second_writer(participant, writes_of(specs), kLoopWriterSearchTime);
  RealtimeScheduling scheduling;
  InProcessStack stack{specs, rig, controller, [&](const ComponentSpec& spec) {
                         return participant.share(spec.source, new_epoch());
                       }};
  enter_realtime(scheduling, stack.node(0), options.priority);
  limit_memory_growth();
  while (!stop_requested()) {
    stack.pump();
    stack.wait(monotonic_ns() + kLongest_ns);
  }
  for (std::size_t i = 0; i < stack.size(); ++i) stack.node(i).stopping();
  return kExitDone;
}

}  // namespace

int run_loop_process(int argc, char** argv, const std::vector<ComponentSpec>& specs) {
  return host(argc, argv, std::string{kLoopProgram},
              "The whole control loop of a simulated crane in one process, in real time.",
              [&specs](const LoopOptions& options) { return run_loop(specs, options); });
}

}  // namespace crane::runtime
