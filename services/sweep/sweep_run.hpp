#pragma once
/// Runs a sweep on several processes and writes its files:
///   sweep.jsonl  log, one line per finished run, from which an interrupted sweep continues
///   runs.csv     every run with its figures
///   sweep.html   tables and distributions
/// The bytes of runs.csv and sweep.html do not depend on the number of processes.
#include <functional>
#include <string>

#include "sweep/results.hpp"

namespace crane::sweep {

inline constexpr const char* kLogFile = "sweep.jsonl";
inline constexpr const char* kRunsFile = "runs.csv";
inline constexpr const char* kPageFile = "sweep.html";

struct Progress {
  std::size_t done = 0, all = 0;  ///< number of runs, including those of earlier calls
  std::size_t new_runs = 0;       ///< finished in this call
  double elapsed_s = 0;           ///< of this call
};
/// "1200 of 5000 runs, 84.1 runs/s, 0:45 left"; without the rate before the first new run.
[[nodiscard]] std::string to_string(const Progress& progress);

struct RunOptions {
  std::filesystem::path directory;  ///< created when missing
  unsigned processes = 1;           ///< >= 1
  std::function<void(const Progress&)> progress{};
  std::function<bool()> cancelled{};
};

/// @return groups of all runs; empty when cancelled, the log then contains the finished runs
/// @throws LogError, files::WriteError
[[nodiscard]] std::vector<Group> run_sweep(const Sweep& sweep, const RunOptions& options);

}  // namespace crane::sweep
