#pragma once
/// Runs scenarios in real time with a stack of processes, on a real or simulated crane: reset, arm, a move to
/// the start of the scenario, then its moves and excitations at their times.
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "crane/experiment/scenario.hpp"
#include "crane/recording/csv.hpp"
#include "crane/runtime/process.hpp"
#include "stack/stack.hpp"

namespace crane::bridge {
class BoardUses;
}
namespace crane::experiments {

class RealtimeSession;

struct RealtimeRun {
  /// time_s is 0 when the crane is in HOLD at the start of the scenario.
  recording::Table table;
  /// Differences between run and scenario, one sentence each: a load that swings at the start, a late
  /// request, missing ticks.
  std::vector<std::string> differences;
};

/// Warning after the use of a real crane: names each axis that is at least 1 mm (1 mrad) away from
/// `[start]`, the position that the next program will assume; empty: no such axis. Omits axes whose
/// position does not come from `[start]` (homing, absolute encoders).
/// @param position  last measured position: trolley m, slew rad, cable length m
[[nodiscard]] std::string difference_from_start(const configuration::Rig& rig,
                                                const std::array<double, 3>& position);

struct RealtimeRunOptions {
  stack::Plant plant = stack::Plant::simulated;
  runtime::BusOptions bus;
  std::map<std::string, std::string> vendors;
};

/// Successive runs on one crane. Each run starts the processes again, and the bridge then sets its
/// incremental encoders to `[start]` of the rig file. A simulated crane starts at this position. A
/// real crane stays where the previous run has left it: its position there replaces `[start]` in
/// the next run, and the load must hang at rest between two runs, because the bridge sets the swing
/// to zero.
class RealtimeRuns {
 public:
  explicit RealtimeRuns(RealtimeRunOptions options);
  ~RealtimeRuns();

  /// Omits kicks, true loads and initial swing of the scenario, which apply to simulations only.
  /// @throws SessionError when the crane was stopped; when, at the end of the previous run, the load was
  ///   swinging, a brake was open, or the position was not observed; when another operator has reset the
  ///   crane, or another bridge has opened the board, since the previous run;
  ///   configuration::ConfigurationError, std::runtime_error
  [[nodiscard]] RealtimeRun run(const std::filesystem::path& rig_file, const std::string& controller,
                                const experiment::Scenario& scenario);

  /// difference_from_start() at the end of the last run on a real crane; empty for a simulated crane.
  [[nodiscard]] std::string difference_from_start(const configuration::Rig& rig) const;

 private:
  struct End {
    std::array<double, 3> position;  ///< trolley m, slew rad, cable length m
    std::string problem;             ///< reason why no further run may start; empty: none
  };
  /// Call when the processes have ended.
  [[nodiscard]] static End observed_end(RealtimeSession& session, const configuration::Rig& rig,
                                        bool load_at_rest);
  [[nodiscard]] RealtimeRun run_from_start(const std::filesystem::path& rig_file,
                                           const std::string& controller,
                                           const experiment::Scenario& scenario);
  /// Call when the bridge of a run has opened the board. @throws SessionError when another bridge has opened
  /// it since the previous run
  void require_sole_use();

  RealtimeRunOptions options_;
  std::optional<End> end_;                         ///< of the last run on a real crane
  std::unique_ptr<bridge::BoardUses> board_uses_;  ///< on a real crane, from the start of the first run on
  std::uint64_t bridges_ = 0;                      ///< number of bridges that the runs have started
};

}  // namespace crane::experiments
