#pragma once
/// Starts the processes of a stack with common options, and waits until all are ready.
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
  runtime::BusOptions bus;  ///< its vendor applies to every process that is not in `vendors`
  std::map<std::string, std::string> vendors;  ///< by component name: "tracking" -> "fastdds"
  std::string rig;
  std::string controller;
  std::string clock = "realtime";
  std::uint32_t epoch = 0;
  int priority = 50;
  bool verbose = false;
  /// The processes of the loop inherit its descriptor. Unused in lockstep, which runs a simulated crane only.
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

/// Longest time until all processes are ready. Discovery of eight cranes that start at the same time in one
/// domain takes up to 14 s on two busy cores, and the time grows with the number of cranes (docs/fleet.md).
inline constexpr std::chrono::seconds kLongestStart{60};

/// Waits until every component has reported ready on crane/node, from a process of `children`.
/// @throws std::runtime_error with the name of a component that ended, or did not report within `patience`
void wait_until_ready(ChildProcesses& children, const std::vector<runtime::ComponentSpec>& specs,
                      bus::Bus& bus, std::chrono::milliseconds patience);

/// One line about a child process that has ended by itself.
[[nodiscard]] std::string describe(const Ended& ended);

}  // namespace crane::stack
