#include "stack/launch.hpp"

#include <unistd.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "crane/configuration/encoder_resolution.hpp"
#include "crane/configuration/realtime_period.hpp"
#include "crane/runtime/loop_process.hpp"
#include "crane/twin/component.hpp"

namespace crane::stack {
namespace {

void start(ChildProcesses& children, std::string_view name, std::string_view program,
           const runtime::BusOptions& bus, const LaunchOptions& options) {
  auto arguments = runtime::arguments(bus);
  arguments.insert(arguments.end(), {"--rig", options.rig, "--clock", options.clock, "--priority",
                                     std::to_string(options.priority)});
  if (!options.controller.empty()) arguments.insert(arguments.end(), {"--controller", options.controller});
  if (options.epoch != 0) arguments.insert(arguments.end(), {"--epoch", std::to_string(options.epoch)});
  arguments.insert(arguments.end(), {"--parent", std::to_string(::getpid())});
  if (options.verbose) arguments.emplace_back("--verbose");
  int inherited = -1;
  if (options.ledger != nullptr && options.clock == "realtime") {
    inherited = options.ledger->descriptor();
    arguments.insert(arguments.end(), {"--ledger", "/proc/self/fd/" + std::to_string(inherited)});
  }
  children.start(std::string{name}, std::string{program}, arguments, inherited);
}

/// Refuses a rig before any process starts. Each process would refuse it by itself.
void require_possible(const configuration::Rig& rig, const LaunchOptions& options) {
  if (options.clock == "realtime") configuration::require_realtime_period(rig);
  configuration::require_resolved_speeds(rig);
}

}  // namespace

std::map<std::string, std::string> vendors_from(const std::vector<std::string>& entries,
                                                const std::vector<runtime::ComponentSpec>& specs) {
  std::map<std::string, std::string> vendors;
  std::vector<std::string> problems;
  for (const auto& entry : entries) {
    const auto equals = entry.find('=');
    const auto name = entry.substr(0, equals);
    const auto vendor = equals == std::string::npos ? "" : entry.substr(equals + 1);
    const bool known = std::any_of(specs.begin(), specs.end(),
                                   [&](const runtime::ComponentSpec& spec) { return spec.name == name; });
    const auto refuse = [&](const std::string& why) {
      problems.push_back("--dds-for " + entry + ": " + why);
    };
    if (!known) refuse("no process has the name '" + name + "'");
    if (vendor != "cyclone" && vendor != "fastdds") refuse("vendor must be cyclone or fastdds");
    vendors[name] = vendor;
  }
  if (!problems.empty()) throw configuration::ConfigurationError{std::move(problems)};
  return vendors;
}

void launch(ChildProcesses& children, const std::vector<runtime::ComponentSpec>& specs,
            const LaunchOptions& options) {
  require_possible(configuration::load_rig(options.rig), options);
  for (const auto& spec : specs) {
    auto bus = options.bus;
    if (const auto chosen = options.vendors.find(std::string{spec.name}); chosen != options.vendors.end())
      bus.vendor = chosen->second;
    start(children, spec.name, spec.program, bus, options);
  }
}

void launch_in_process(ChildProcesses& children, const LaunchOptions& options) {
  require_possible(configuration::load_rig(options.rig), options);
  start(children, "loop", runtime::kLoopProgram, options.bus, options);
}

void launch_rig(ChildProcesses& children, const configuration::Rig& rig, const LaunchOptions& options) {
  require_possible(rig, options);
  if (rig.board != "emulated") return;
  // The emulated rig replaces hardware: it must preempt the processes of the stack.
  const int priority = options.priority > 0 ? options.priority + 1 : 0;
  children.start(
      "emulated_rig", "crane_emulated_rig",
      {"--rig", options.rig, "--crane", options.bus.crane, "--domain", std::to_string(options.bus.domain),
       "--clock", options.clock, "--priority", std::to_string(priority)});
}

void launch_twin(ChildProcesses& children, const std::string& rig, LaunchOptions options) {
  const auto chosen = options.vendors.find("twin");
  options.bus.vendor = chosen != options.vendors.end() ? chosen->second : "fastdds";
  options.rig = rig;
  options.priority = 0;
  options.ledger = nullptr;  // the twin is not a process of the loop
  launch(children, {twin::twin_spec()}, options);
}

std::string describe(const Ended& ended) { return ended.name + " has ended: " + ended.how; }

void wait_until_ready(ChildProcesses& children, const std::vector<runtime::ComponentSpec>& specs,
                      bus::Bus& bus, std::chrono::milliseconds patience,
                      const std::function<bool(const Ended&)>& continues_without) {
  auto statuses = bus.subscriber(topics::node);
  std::set<std::string> missing;
  for (const auto& spec : specs) missing.insert(std::string{spec.name});
  const auto deadline_ns = runtime::monotonic_ns() + std::chrono::nanoseconds{patience}.count();
  while (!missing.empty()) {
    bus.wait(std::chrono::milliseconds{20});
    while (const auto status = statuses.take())
      if (status->phase == crane_PHASE_READY && children.contains(static_cast<pid_t>(status->pid)))
        missing.erase(status->name);
    if (const auto ended = children.ended())
      if (!continues_without || !continues_without(*ended)) throw std::runtime_error(describe(*ended));
    if (runtime::stop_requested()) throw std::runtime_error("interrupted");
    if (runtime::monotonic_ns() < deadline_ns) continue;
    std::string names;
    for (const auto& name : missing) names += (names.empty() ? "" : ", ") + name;
    throw std::runtime_error("not ready after " + std::to_string(patience.count()) + " ms: " + names +
                             "; check their messages above, --interface and --domain");
  }
}

}  // namespace crane::stack
