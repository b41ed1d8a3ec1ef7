#pragma once
/// Runs one component in a process: command line, rig file, bus, signals, loop.
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
inline constexpr int kExitFailed = 1;    ///< failure at run time; standard error states the reason
inline constexpr int kExitBadInput = 2;  ///< wrong arguments or files

/// Options of every process of a stack and of every tool.
struct BusOptions {
  std::string vendor = "cyclone";
  std::uint32_t domain = 0;
  std::string crane = "crane";
  std::vector<std::string> interfaces{"127.0.0.1"};
  std::vector<std::string> peers;
  std::string discovery_server;  ///< as bus::Options::discovery_server
  std::string secure;            ///< directory of keys; empty: DDS Security is off
  bool insecure = false;         ///< true: the user permits access from other hosts without keys
};
void add_bus_options(CLI::App& app, BusOptions& options);
/// @throws ConfigurationError when keys are missing or do not fit the source, and when a process that writes
/// would be reachable from other hosts without keys and without `insecure`
[[nodiscard]] bus::Options bus_options(const BusOptions& options, std::string participant,
                                       crane_Source source, std::uint32_t epoch);
/// @return true when other hosts can reach this bus and no keys restrict who may write to it
[[nodiscard]] bool is_insecure(const bus::Options& options);
/// Converts options to command-line arguments for a child process.
[[nodiscard]] std::vector<std::string> arguments(const BusOptions& options);

/// Options of a process of the control loop.
struct LoopOptions {
  BusOptions bus;
  std::string rig;         ///< path of the rig file
  std::string controller;  ///< empty: the controller of the rig file
  std::string clock = "realtime";
  std::uint32_t epoch = 0;  ///< start-up number; 0: a random number
  int priority = 50;        ///< SCHED_FIFO priority in realtime, 0 to 98; 0: ordinary scheduling
  std::string ledger;       ///< path of the ledger of the stack (crane/bus/ledger.hpp); empty: none
  int parent = 0;           ///< process id of the parent; this process ends when the parent ends; 0: none
  bool verbose = false;
};
void add_loop_options(CLI::App& app, LoopOptions& options);

/// @param name  empty: the controller of the rig file
/// @throws ConfigurationError with the list of controllers when the name does not exist
[[nodiscard]] const control::Controller& chosen_controller(const std::string& name,
                                                           const configuration::Rig& rig);

/// Start-up number of a process: random, never 0. A start-up number is not a time, so that clock differences
/// between hosts have no effect. Only SoleSupervisor compares two start-up numbers by size.
[[nodiscard]] std::uint32_t random_epoch();

/// Time for which a process searches for another writer before its first sample. Discovery across vendors can
/// take longer; therefore the readers also check for a second writer at every tick (writer_binding.hpp).
inline constexpr std::chrono::milliseconds kWriterSearchTime{400};
/// kWriterSearchTime of a process with all components of the loop: longer than discovery across
/// vendors (up to 1 s), because the first samples of this process would stop another stack.
inline constexpr std::chrono::milliseconds kLoopWriterSearchTime{1200};

/// @throws bus::Error that names both versions when a program of this crane has messages of another version
void refuse_other_version(bus::Bus& bus);

/// Searches for other writers of the loop topics in `writes`, and for programs with another version of the
/// messages, for the time `search_time`. @throws bus::Error that names the writer (program, process id, host)
/// and the remedy when one exists
void refuse_second_writer(bus::Bus& bus, const std::vector<Write>& writes,
                          std::chrono::milliseconds search_time = kWriterSearchTime);

/// main() of every process of the stack. @return exit code
int run_process(int argc, char** argv, const ComponentSpec& spec);

[[nodiscard]] std::int64_t monotonic_ns();

}  // namespace crane::runtime
