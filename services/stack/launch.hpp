#pragma once
/// Starts the processes of a stack with the options they share, and waits until all of them are ready.
#include <map>
#include <string>
#include <vector>

#include "crane/bus/bus.hpp"
#include "crane/runtime/process.hpp"
#include "stack/child_processes.hpp"

namespace crane::stack {

struct LaunchOptions {
  runtime::BusOptions bus;                     ///< vendor: of every process not named in `vendors`
  std::map<std::string, std::string> vendors;  ///< by component name: "tracking" -> "fastdds"
  std::string rig;
  std::string controller;
  std::string clock = "realtime";
  std::uint32_t epoch = 0;
  int priority = 50;
  bool verbose = false;
};

/// "NAME=VENDOR" entries as given to --dds-for. @throws configuration::ConfigurationError for an unknown name
/// or vendor
[[nodiscard]] std::map<std::string, std::string> vendors_from(
    const std::vector<std::string>& entries, const std::vector<runtime::ComponentSpec>& specs);

/// @throws std::runtime_error when a program is missing
void launch(ChildProcesses& children, const std::vector<runtime::ComponentSpec>& specs,
            const LaunchOptions& options);

/// The process a rig needs besides the stack's: the emulated crane of an emulated board, else nothing.
/// @throws std::runtime_error when the program is missing
void launch_rig(ChildProcesses& children, const configuration::Rig& rig, const LaunchOptions& options);

/// The model beside the crane, off the loop: ordinary scheduling, and the observers' vendor unless `vendors`
/// has "twin".
/// @param rig file of the model. @throws std::runtime_error when the program is missing
void launch_twin(ChildProcesses& children, const std::string& rig, LaunchOptions options);

/// Waits until every component has reported ready on crane/node.
/// @throws std::runtime_error naming who ended or did not report within `patience`
void wait_until_ready(ChildProcesses& children, const std::vector<runtime::ComponentSpec>& specs,
                      bus::Bus& bus, std::chrono::milliseconds patience);

/// One line about a child that ended by itself.
[[nodiscard]] std::string describe(const Ended& ended);

}  // namespace crane::stack
