#pragma once
/// Fault-injection campaign: many faults on many simulated cranes. A run is defined, and can be
/// repeated, by its Tuple (hazard, moment, seed). The crane is prepared once per setting and
/// moment; every run continues in a forked process, so that runs share only the preparation.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "campaign/hazards.hpp"
#include "campaign/judge/judge.hpp"

namespace crane::campaign {

struct Tuple {
  int hazard = 0;
  Moment moment = Moment::armed_idle;
  std::uint64_t seed = 0;
  [[nodiscard]] auto operator<=>(const Tuple&) const = default;
};
/// "--hazard 16 --moment cruise --seed 7"
[[nodiscard]] std::string to_string(const Tuple& tuple);

/// Result of one run, as its process returns it.
struct Result {
  Tuple tuple{};
  std::uint32_t violations = 0;  ///< bit i: Invariant i
  bool crashed = false;          ///< the process of the run ended without a result
  bool prepared = true;          ///< false: the crane did not reach the moment; the run was not judged
  bool stopped = false;          ///< true: the crane stopped after the onset
  bool right = false;            ///< true: the first reason was an expected one
  Reason first{};                ///< reason of the first stop after the onset
  double detection_ms = -1, zero_volts_ms = -1, braked_ms = -1;  ///< as in Verdict; -1: none
  double bound_ms = 0;                                           ///< longest permitted detection time
  double beyond_limit = 0;                                       ///< as in Verdict, m or rad
  char what[120] = {};                                           ///< description of the first violation
};

struct Selection {
  std::vector<int> hazards{};               ///< empty: all
  std::vector<Moment> moments{};            ///< empty: all
  std::uint64_t first_seed = 0, seeds = 1;  ///< their sum must be representable
};
/// All tuples, in the order of settings and moments.
[[nodiscard]] std::vector<Tuple> tuples(const Selection& selection);

/// Runs one tuple in this process. @param recording  MCAP file to write; nothing: none
[[nodiscard]] Result run_one(const Tuple& tuple, const std::optional<std::filesystem::path>& recording = {});

/// Runs all tuples, `jobs` at a time. @param done  called for each result, in any order
void run_all(const std::vector<Tuple>& tuples, unsigned jobs, const std::function<void(const Result&)>& done);

/// Result of runs without faults: virtual time, and all stops that the operator did not request. A move may
/// cross a limit; the stop is then correct when the true state confirms its reason (judge/truth.hpp). Any
/// other stop is a false trip.
struct FaultFree {
  double hours = 0;
  std::vector<std::string> trips{};   ///< "gain_scheduling_partial on gantry, after 812.4 s: FOLLOWING_ERROR"
  std::vector<std::string> limits{};  ///< same form: stops at a limit that the move has crossed
};
/// Moves to random targets on every rig and controller; some moves are interrupted by another move, a stop or
/// a disarm. @param hours  virtual time
[[nodiscard]] FaultFree run_fault_free(double hours, unsigned jobs, std::uint64_t seed);

}  // namespace crane::campaign
