#pragma once
/// Starts the processes of a stack with common options, and waits until all are ready.
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "crane/bus/bus.hpp"
#include "crane/bus/ledger.hpp"
#include "crane/runtime/process.hpp"
#include "stack/child_processes.hpp"

namespace crane::stack {

struct LaunchOptions {
  runtime::BusOptions bus;                     ///< bus.vendor: DDS of the processes not in `vendors`
  std::map<std::string, std::string> vendors;  ///< by component name: "tracking" -> "fastdds"
  std::string rig;                             ///< rig file
  std::string controller;                      ///< empty: the controller of the rig file
  std::string clock = "realtime";              ///< "realtime" or "lockstep"
  std::uint32_t epoch = 0;                     ///< start-up number of all processes; 0: random
  int priority = 50;                           ///< SCHED_FIFO priority; 0: ordinary scheduling
  bool verbose = false;                        ///< true: debug messages
  /// The processes of the loop inherit the descriptor of the ledger. Unused in lockstep.
  std::shared_ptr<bus::Ledger> ledger = bus::Ledger::create();
};

/// Parses the "NAME=VENDOR" arguments of --dds-for. @throws configuration::ConfigurationError for an unknown
/// name or vendor
[[nodiscard]] std::map<std::string, std::string> vendors_from(
    const std::vector<std::string>& entries, const std::vector<runtime::ComponentSpec>& specs);

/// @throws std::runtime_error when a program is missing
void launch(ChildProcesses& children, const std::vector<runtime::ComponentSpec>& specs,
            const LaunchOptions& options);

/// Starts one process that hosts all components of the simulated stack, in real time
/// (crane/runtime/loop_process.hpp). Its name is "loop".
/// @throws std::runtime_error when the program is missing
void launch_in_process(ChildProcesses& children, const LaunchOptions& options);

/// Starts the process of the emulated crane when the rig has an emulated board.
/// @throws std::runtime_error when the program is missing
void launch_rig(ChildProcesses& children, const configuration::Rig& rig, const LaunchOptions& options);

/// Starts the live twin with ordinary scheduling, and with the vendor of the tools unless `vendors` contains
/// "twin".
/// @param rig  rig file of the model. @throws std::runtime_error when the program is missing
void launch_twin(ChildProcesses& children, const std::string& rig, LaunchOptions options);

/// Longest time until all processes are ready. The discovery of eight cranes that start together in one
/// domain takes up to 14 s on two busy cores; the time grows with the number of cranes (docs/fleet.md).
inline constexpr std::chrono::seconds kLongestStart{60};

/// Waits until every component has reported ready on crane/node, from a process of `children`.
/// @param continues_without  called for a child process that has ended; true: the start continues. Empty: the
///   end of any child process ends the start
/// @throws std::runtime_error that names a process that has ended, or a component that did not report within
///   `patience`
void wait_until_ready(ChildProcesses& children, const std::vector<runtime::ComponentSpec>& specs,
                      bus::Bus& bus, std::chrono::milliseconds patience,
                      const std::function<bool(const Ended&)>& continues_without = {});

/// One line about a child process that has ended by itself.
[[nodiscard]] std::string describe(const Ended& ended);

}  // namespace crane::stack
