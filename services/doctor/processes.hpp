#pragma once
/// The crane's processes on this computer, from their command lines.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "doctor/finding.hpp"

namespace crane::doctor {

struct LocalProcess {
  int pid = 0;
  std::string program;  ///< "crane_tracking"
  std::string crane = "crane";
  std::uint32_t domain = 0;
  std::vector<std::string> interfaces{"127.0.0.1"};
  bool secure = false;
  bool stopped = false;  ///< true: stopped by a signal or a debugger
  /// True for a process of the control loop; false for a tool.
  [[nodiscard]] bool in_loop() const;
};

/// Parses a command line. @param arguments  begin with the program
[[nodiscard]] LocalProcess process_from(const std::vector<std::string>& arguments);

/// Processes of this project in this network namespace. @param proc  "/proc"
[[nodiscard]] std::vector<LocalProcess> local_processes(const std::filesystem::path& proc = "/proc");

/// Stopped processes and duplicate programs of this crane and domain.
[[nodiscard]] Findings judge_processes(const std::vector<LocalProcess>& processes, const std::string& crane,
                                       std::uint32_t domain);

}  // namespace crane::doctor
