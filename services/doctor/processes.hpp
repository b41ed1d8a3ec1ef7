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
  bool stopped = false;  ///< by a signal or a debugger
  /// Of the control loop; the others are tools.
  [[nodiscard]] bool in_loop() const;
};

/// What a command line says. @param arguments  the program first
[[nodiscard]] LocalProcess process_from(const std::vector<std::string>& arguments);

/// Processes of this project in this network namespace. @param proc  "/proc"
[[nodiscard]] std::vector<LocalProcess> local_processes(const std::filesystem::path& proc = "/proc");

/// Stopped processes, and two of one program: of the crane and domain.
[[nodiscard]] Findings judge_processes(const std::vector<LocalProcess>& processes, const std::string& crane,
                                       std::uint32_t domain);

}  // namespace crane::doctor
