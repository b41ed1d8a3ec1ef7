#pragma once
/// The dashboard as a program: `crane_dashboard`, and the command `crane dashboard`.
#include <string>
#include <vector>

#include "crane/runtime/process.hpp"
#include "stack/child_processes.hpp"

namespace crane::dashboard {

struct Options {
  std::string listen = "127.0.0.1";
  unsigned short port = 8765;  ///< default port of foxglove.websocket.v1; 0: any free port
  std::string token_file;
  std::vector<std::string> host_names, other_origins;
  bool read_only = false;
  std::string runs;  ///< directory of recordings for the views Runs and Diagnose; empty: none
  std::string rig;   ///< name or path of a rig file; empty: unknown
  int parent = 0;    ///< process id of the parent; this process ends when the parent ends; 0: none
  runtime::BusOptions bus;
};
[[nodiscard]] Options default_options();
void add_options(CLI::App& app, Options& options);

/// Runs until a stop signal. @return exit code. @throws ConfigurationError, std::runtime_error
int run(const Options& options);

/// Starts crane_dashboard as a child process with the DDS vendor of the tools. The child prints its address
/// when it is ready.
void launch(stack::ChildProcesses& children, runtime::BusOptions bus, const std::string& rig,
            const std::string& runs, unsigned short port);

/// main() of crane_dashboard.
int main_of(int argc, char** argv);

/// "http://127.0.0.1:8765/"
[[nodiscard]] std::string address_of(const std::string& listen, unsigned short port);

}  // namespace crane::dashboard
