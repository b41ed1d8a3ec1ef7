#pragma once
/// Results of a sweep: a log with one line per run, from which an interrupted sweep continues, and the table
/// and page that are generated from it.
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "crane/report/page.hpp"
#include "sweep/sweep.hpp"

namespace crane::sweep {

/// Result of one run: "run", "stopped_because" (empty: complete) and the figures of experiment::to_json(),
/// which are missing when the run ended before its last action.
using Result = nlohmann::ordered_json;

[[nodiscard]] Result result_of(const Run& run, const experiment::ComparedRun& outcome);
/// Result of a run whose process ended without a result.
[[nodiscard]] Result failed(const Run& run, const std::string& failure);

/// The log belongs to another sweep or cannot be read or written. what() names the file and the remedy.
class LogError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Log with one line per finished run. Opening removes an incomplete last line of a killed program.
class Log {
 public:
  /// Opens the log of this sweep, or creates it. @throws LogError
  Log(std::filesystem::path file, const Sweep& sweep);
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  [[nodiscard]] const std::map<std::size_t, Result>& results() const { return results_; }
  /// @throws LogError
  void add(const Result& result);

 private:
  void read(const std::string& identity);
  void append(const std::string& line);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::size_t runs_;
  std::map<std::size_t, Result> results_;  ///< by run number
};

/// CSV, one row per run in the order of their numbers: run, scenario, rig, variant, controller, seed, the
/// drawn values under their keys, stopped_because, and the figures. @pre results has every run of the sweep
[[nodiscard]] std::string csv_of(const Sweep& sweep, const std::map<std::size_t, Result>& results);

/// Runs with equal scenario, rig, variant and controller.
struct Group {
  const Case* on = nullptr;
  std::string variant{}, controller{};
  std::size_t runs = 0, stopped = 0;
  std::vector<double> settling_s{};            ///< of the settled runs, increasing
  std::vector<double> largest_swing_deg{};     ///< of all runs with figures, increasing
  std::map<std::string, std::size_t> stops{};  ///< number of runs by cause of the stop
};
[[nodiscard]] std::vector<Group> groups_of(const Sweep& sweep, const std::map<std::size_t, Result>& results);

/// Quantile of increasing values; NaN without values. @param share  in [0, 1]
[[nodiscard]] double quantile(const std::vector<double>& sorted, double share);

[[nodiscard]] std::string summary_of(const std::vector<Group>& groups);
[[nodiscard]] report::Page page_of(const Sweep& sweep, const std::vector<Group>& groups);

}  // namespace crane::sweep
