#pragma once
/// The black box as a program: `crane black-box`, which `crane up` starts. It listens to every topic, keeps
/// the newest samples in memory, and writes a recording at every stop, fault and trip (moments.hpp).
#include <filesystem>
#include <string>

#include "crane/runtime/process.hpp"

namespace crane::black_box {

struct Options {
  std::filesystem::path directory;  ///< is made when it does not exist
  std::string rig;                  ///< name or path of a rig file, which is attached; empty: unknown
  int parent = 0;                   ///< process that this one ends with; 0: none
  std::size_t files = 64;           ///< newest files that are kept; a file has about 1 MB
  runtime::BusOptions bus;
};
/// $XDG_STATE_HOME/crane/black_box, or ~/.local/state/crane/black_box
[[nodiscard]] std::filesystem::path default_directory();
[[nodiscard]] Options default_options();
void add_options(CLI::App& app, Options& options);

/// Runs until a stop signal; then writes what waits. @return exit code. @throws ConfigurationError,
/// bus::Error
int run(const Options& options);

}  // namespace crane::black_box
