#pragma once
/// The program `crane black-box`, which `crane up` starts. It receives every topic, keeps the newest samples
/// in memory, and writes a recording at every stop, fault and trip (incidents.hpp).
#include <filesystem>
#include <string>

#include "crane/runtime/process.hpp"

namespace crane::black_box {

struct Options {
  std::filesystem::path directory;  ///< created when missing
  std::string rig;                  ///< name or path of the rig file, which is attached; empty: unknown
  int parent = 0;          ///< process id of the parent; this process ends when the parent ends; 0: none
  std::size_t files = 64;  ///< number of files that are kept; a file has about 1 MB
  runtime::BusOptions bus;
};
/// $XDG_STATE_HOME/crane/black_box, or ~/.local/state/crane/black_box; without both variables, a directory of
/// this user in the temporary directory
[[nodiscard]] std::filesystem::path default_directory();
[[nodiscard]] Options default_options();
void add_options(CLI::App& app, Options& options);

/// Runs until a stop signal, and then writes an open incident. @return exit code. @throws ConfigurationError,
/// bus::Error
int run(const Options& options);

}  // namespace crane::black_box
