#pragma once
/// Stability margins of a law, from simulated maneuvers on changed rigs.
#include <array>
#include <optional>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/experiment/comparison.hpp"

namespace crane::tuning {

/// Required margins. Chosen: a delay margin of one control period, because a command may act one tick late; a
/// gain margin of 2, the usual 6 dB.
inline constexpr double kRequiredDelay_periods = 1, kRequiredGain = 2;

/// Tested delays, in periods, and gains, in ascending order.
inline constexpr std::array kTestedDelays_periods{1.0, 2.0, 3.0, 5.0};
inline constexpr std::array kTestedGains{1.5, 2.0, 3.0};
/// Relative changes of cable length, load mass and friction on which a law must stay stable.
inline constexpr double kCableChange = 0.2, kLoadChange = 0.5, kFrictionChange = 0.2;

struct Margins {
  double delay_periods = 0;  ///< largest tested additional delay with a stable loop
  double gain = 1;           ///< largest tested factor of the gains with a stable loop
  /// true: stable with each changed cable and load, and no stop by the supervisor with changed friction
  bool survives_changes = false;
  /// Largest mean settling time on a changed rig; nothing: the loop does not settle on every changed rig.
  std::optional<double> changed_settling_s;
  [[nodiscard]] bool holds() const {
    return delay_periods >= kRequiredDelay_periods && gain >= kRequiredGain && survives_changes;
  }
};

/// @return nothing when one of the times is missing
[[nodiscard]] std::optional<double> mean_of(const std::vector<std::optional<double>>& times);

/// Collects the runs of one law on all changed rigs. A case is one changed rig.
class MarginRuns {
 public:
  /// Shorter, longer cable; lighter, heavier load; less, more friction.
  static constexpr std::size_t kChanges = 6;
  static constexpr std::size_t kCases = kTestedDelays_periods.size() + kTestedGains.size() + kChanges;

  explicit MarginRuns(std::size_t maneuvers);
  [[nodiscard]] std::size_t size() const { return stable_.size(); }
  /// @return the changed rig of a case
  static configuration::Rig truth_of(const configuration::Rig& truth, std::size_t number);
  /// @param run  case * maneuvers + maneuver
  void take(std::size_t run, const experiment::ComparedRun& result);
  [[nodiscard]] Margins margins() const;

 private:
  /// True when the result of every maneuver of case `number` is true.
  [[nodiscard]] bool all(const std::vector<bool>& results, std::size_t number) const;

  std::size_t maneuvers_;
  std::vector<bool> stable_, complete_;
  std::vector<std::optional<double>> settling_;
};

}  // namespace crane::tuning
