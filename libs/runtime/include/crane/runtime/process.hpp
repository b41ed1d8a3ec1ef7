#pragma once
/// A component in a process of its own: command line, rig file, bus, signals, the loop.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "crane/bus/bus.hpp"
#include "crane/runtime/component.hpp"
#include "crane/runtime/signals.hpp"

namespace CLI {
class App;
}

namespace crane::runtime {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;    ///< it did not work; the reason is on standard error
inline constexpr int kExitBadInput = 2;  ///< arguments or files

/// Options every process of a stack and every tool has.
struct BusOptions {
  std::string vendor = "cyclone";
  std::uint32_t domain = 0;
  std::string crane = "crane";
  std::vector<std::string> interfaces{"127.0.0.1"};
  std::vector<std::string> peers;
  std::string secure;     ///< directory of keys; empty: DDS Security is off
  bool insecure = false;  ///< beyond the loop-back without keys, on purpose
};
void add_bus_options(CLI::App& app, BusOptions& options);
/// @throws ConfigurationError when keys are missing or do not fit the source, and when a process that writes
/// would be reachable from other hosts without keys and without `insecure`
[[nodiscard]] bus::Options bus_options(const BusOptions& options, std::string participant,
                                       crane_Source source, std::uint32_t epoch);
/// Other hosts can reach this bus, and no keys keep them out.
[[nodiscard]] bool is_insecure(const bus::Options& options);
/// The same options as command-line arguments, for a child process.
[[nodiscard]] std::vector<std::string> arguments(const BusOptions& options);

/// Options of a process in the loop.
struct LoopOptions {
  BusOptions bus;
  std::string rig;
  std::string controller;  ///< empty: the rig file's
  std::string clock = "realtime";
  std::uint32_t epoch = 0;  ///< 0: a random start-up number
  int priority = 50;        ///< SCHED_FIFO priority in realtime, 0: ordinary scheduling
  int parent = 0;           ///< process id; not 0: this process ends with that one
  bool verbose = false;
};
void add_loop_options(CLI::App& app, LoopOptions& options);

/// The controller a loop runs. @throws ConfigurationError when the name does not exist, listing those that do
[[nodiscard]] const control::Controller& chosen_controller(const std::string& name, const Rig& rig);

/// Start-up number of a process: random, never 0. Numbers are compared for equality only, so that no clock
/// decides which of two processes is believed.
[[nodiscard]] std::uint32_t random_epoch();

/// How long a process looks for another writer before it writes. Discovery across vendors may take longer;
/// the readers look for a second writer at every tick (writer_binding.hpp).
inline constexpr std::chrono::milliseconds kSoleWriterLook{400};

/// Looks for other writers of the loop topics among `writes` for kSoleWriterLook. @throws bus::Error with the
/// remedy when there is one
void refuse_second_writer(bus::Bus& bus, const std::vector<Write>& writes);

/// main() of every process of the stack. @return exit code
int run_process(int argc, char** argv, const ComponentSpec& spec);

[[nodiscard]] std::int64_t monotonic_ns();

}  // namespace crane::runtime
