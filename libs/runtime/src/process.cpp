#include "crane/runtime/process.hpp"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <ctime>
#include <random>
#include <system_error>

#include "crane/bus/ledger.hpp"
#include "crane/bus/path_stamps.hpp"
#include "crane/configuration/encoder_resolution.hpp"
#include "crane/configuration/realtime_period.hpp"
#include "crane/runtime/hosted_component.hpp"
#include "crane/runtime/memory_limit.hpp"
#include "crane/runtime/signals.hpp"
#include "crane/runtime/turn.hpp"
#include "host.hpp"

namespace crane::runtime {
namespace {

void sleep_until(std::int64_t time_ns) {
  const timespec at{.tv_sec = time_ns / 1'000'000'000, .tv_nsec = time_ns % 1'000'000'000};
  const int error = ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
  if (error != 0 && error != EINTR)  // a signal may end the sleep early, before a tick is due
    throw std::system_error{error, std::generic_category(), "clock_nanosleep"};
}

/// A clock master sleeps until its next tick; samples do not wake it.
void loop_paced(Component& component) {
  auto* const stamps = bus::path_stamps();
  while (!stop_requested()) {
    const auto now_ns = monotonic_ns();
    if (stamps != nullptr) stamps->polled(now_ns);
    if (!component.poll(now_ns)) sleep_until(std::min(component.wake_at_ns(), now_ns + kLongest_ns));
  }
}

/// Ends the turn when the loop ends, normally or by an exception: after that, no thread runs the component.
struct EndOfTurn {
  Turn& turn;
  ~EndOfTurn() { turn.end(); }
};

/// The thread that delivers a sample runs the component; this thread runs it when turn.wait() returns.
void loop_on_arrival(Component& component, std::int64_t period_ns, Turn& turn) {
  const EndOfTurn end_of_turn{turn};
  turn.begin(component, period_ns);
  while (!stop_requested()) {
    turn.wait(kLongest_ns);
    turn.run();
  }
}

int run(const ComponentSpec& spec, const LoopOptions& options) {
  const auto rig = configuration::load_rig(options.rig);
  const auto& controller = chosen_controller(options.controller, rig);
  const auto clock = clock_from(options.clock);
  if (clock == Clock::realtime) configuration::require_realtime_period(rig);
  configuration::require_resolved_speeds(rig);
  const auto epoch = options.epoch != 0 ? options.epoch : random_epoch();
  bus::stamp_paths_if_asked();
  Turn turn{monotonic_ns};  // outlives the bus, whose threads call it
  auto joining = bus_options(options.bus, std::string{spec.program}, spec.source, epoch);
  if (!options.ledger.empty()) joining.ledger = bus::Ledger::open(options.ledger);
  bus::Bus bus{std::move(joining)};
  refuse_second_writer(bus, spec.writes);
  bus.call_on_arrival([&turn, &spec](std::string_view topic) {
    // The delivery of a sample must not publish the same topic (see Bus::call_on_arrival).
    if (writes(spec, topic))
      turn.wake();
    else
      turn.run();
  });
  RealtimeScheduling scheduling;  // outlives the component, which closes the brakes when it ends
  HostedComponent hosted{bus, spec, rig, controller, clock, monotonic_ns};
  if (clock == Clock::realtime) enter_realtime(scheduling, hosted.node(), options.priority);
  limit_memory_growth();
  if (hosted.component().paced())
    loop_paced(hosted.component());
  else
    loop_on_arrival(hosted.component(),
                    clock == Clock::realtime ? static_cast<std::int64_t>(rig.period_s * 1e9) : 0, turn);
  hosted.node().stopping();
  return kExitDone;
}

}  // namespace

std::int64_t monotonic_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

void add_loop_options(CLI::App& app, LoopOptions& options) {
  add_bus_options(app, options.bus);
  app.add_option("--rig", options.rig, "rig file (deploy/rigs/*.toml)")->required();
  app.add_option("--controller", options.controller, "controller; default: the controller of the rig file");
  app.add_option("--clock", options.clock,
                 "realtime: one tick per period; lockstep: the plant waits for every command")
      ->check(CLI::IsMember({"realtime", "lockstep"}))
      ->capture_default_str();
  app.add_option("--epoch", options.epoch, "start-up number in the header of every sample; 0: random");
  app.add_option("--priority", options.priority, "SCHED_FIFO priority in realtime, 0: ordinary scheduling")
      ->check(CLI::Range(0, 98))
      ->capture_default_str();
  app.add_option("--ledger", options.ledger,
                 "ledger of the stack: accept only samples that a process with this file has sent; crane up "
                 "passes it to the processes of the loop");
  app.add_option("--parent", options.parent, "end when the process with this id ends; 0: never");
  app.add_flag("--verbose", options.verbose, "log every detail");
}

const control::Controller& chosen_controller(const std::string& name, const configuration::Rig& rig) {
  const auto& wanted = name.empty() ? rig.controller : name;
  if (const auto* controller = control::find_controller(wanted)) {
    auto problems = control::problems(*controller, rig.design);
    for (auto& problem : problems) problem.insert(0, rig.path + ": ");
    if (!problems.empty()) throw configuration::ConfigurationError(std::move(problems));
    return *controller;
  }
  std::string known;
  for (const auto& controller : control::controllers())
    known += (known.empty() ? "" : ", ") + std::string{controller.name};
  throw configuration::ConfigurationError({"controller = " + wanted + ": must be one of " + known});
}

std::uint32_t random_epoch() {
  std::random_device device;
  return std::uniform_int_distribution<std::uint32_t>{1}(device);
}

void refuse_other_version(bus::Bus& bus) {
  const auto others = bus.other_versions();
  if (!others.empty()) throw bus::Error(bus::refusal(others.front(), bus.options().messages_version));
}

namespace {

/// @return " (crane_supervisor, pid 123 on HOST, 0110...)"; empty when no writer of the topic is known yet
std::string named_writers(const bus::CdrSubscriber& probe) {
  std::vector<bus::WriterId> writers;
  probe.matched_writers(writers);
  std::string names;
  for (const auto& writer : writers)
    if (const auto origin = probe.origin_of(writer); !origin.empty())
      names += (names.empty() ? "" : "; ") + origin;
  return names.empty() ? names : " (" + names + ')';
}

}  // namespace

void refuse_second_writer(bus::Bus& bus, const std::vector<Write>& writes,
                          std::chrono::milliseconds search_time) {
  std::vector<bus::CdrSubscriber> probes;
  for (const auto& write : writes)
    if (write.topic->every_tick) probes.push_back(bus.cdr_subscriber(*write.topic));
  if (probes.empty()) return;
  const auto end_ns = monotonic_ns() + std::chrono::nanoseconds{search_time}.count();
  while (monotonic_ns() < end_ns && !stop_requested()) {
    bus.wait(std::chrono::milliseconds{10});
    refuse_other_version(bus);
    for (const auto& probe : probes)
      if (probe.matched() > 0)
        throw bus::Error("another process already writes " + std::string{probe.topic().name} + " of crane '" +
                         bus.options().crane + "' in domain " + std::to_string(bus.options().domain) +
                         named_writers(probe) +
                         ": stop that stack first, or choose another --crane or --domain");
  }
}

int run_process(int argc, char** argv, const ComponentSpec& spec) {
  return host(argc, argv, std::string{spec.program}, std::string{spec.summary},
              [&spec](const LoopOptions& options) { return run(spec, options); });
}

}  // namespace crane::runtime
