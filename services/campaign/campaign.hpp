#pragma once
/// Many faults on many cranes, each run reproducible from its tuple. A crane is prepared once for every
/// setting and moment; each run goes on from there in a process of its own (fork), so that runs share the
/// preparation and nothing else.
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

/// One run in the form in which it comes back from its process.
struct Result {
  Tuple tuple{};
  std::uint32_t violations = 0;  ///< bit i: Invariant i
  bool crashed = false;          ///< the process of the run ended by itself
  bool prepared = true;          ///< false: the crane did not come to the moment; nothing was judged
  bool stopped = false, right = false;
  Reason first{};
  double detection_ms = -1, zero_volts_ms = -1, braked_ms = -1;  ///< < 0: none
  double bound_ms = 0;                                           ///< of the detection
  double beyond_limit = 0;
  char what[120] = {};  ///< of the first violation
};

struct Selection {
  std::vector<int> hazards{};     ///< empty: all
  std::vector<Moment> moments{};  ///< empty: all
  std::uint64_t first_seed = 0, seeds = 1;
};
/// Every tuple, in the order of settings and moments.
[[nodiscard]] std::vector<Tuple> tuples(const Selection& selection);

/// One run in this process. @param recording  MCAP file to be left; nothing: none
[[nodiscard]] Result run_one(const Tuple& tuple, const std::optional<std::filesystem::path>& recording = {});

/// All runs, `jobs` at a time. @param done  called for each, in any order
void run_all(const std::vector<Tuple>& tuples, unsigned jobs, const std::function<void(const Result&)>& done);

/// Result of fault-free runs: hours of virtual time, and every stop that no operator asked for. A move may
/// drive a crane beyond a limit, and is then stopped for a reason that the truth confirms (judge/truth.hpp);
/// any other stop is a false trip.
struct FaultFree {
  double hours = 0;
  std::vector<std::string> trips{};   ///< "gain_scheduling_partial on gantry, after 812.4 s: FOLLOWING_ERROR"
  std::vector<std::string> limits{};  ///< the same: stopped at a limit that the move has really crossed
};
/// Moves to random targets without an end, some of them interrupted by the next one, by a stop or a disarm,
/// on every rig and controller. @param hours  of virtual time
[[nodiscard]] FaultFree run_fault_free(double hours, unsigned jobs, std::uint64_t seed);

}  // namespace crane::campaign
