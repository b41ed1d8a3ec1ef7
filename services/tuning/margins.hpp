#pragma once
/// Margins of a law: the changes of a rig on which the loop stays stable, by simulated maneuvers.
#include <array>
#include <optional>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/experiment/comparison.hpp"

namespace crane::tuning {

/// Required margins, chosen. Delay: one period of the loop; a law without this margin is unstable when its
/// commands act one tick late. Gain: 2, the 6 dB that are common in practice.
inline constexpr double kRequiredDelay_periods = 1, kRequiredGain = 2;

/// Tested delays, in periods, and gains, in ascending order.
inline constexpr std::array kTestedDelays_periods{1.0, 2.0, 3.0, 5.0};
inline constexpr std::array kTestedGains{1.5, 2.0, 3.0};
/// Changes of cable length, load mass and friction that a rig must survive.
inline constexpr double kCableChange = 0.2, kLoadChange = 0.5, kFrictionChange = 0.2;

struct Margins {
  double delay_periods = 0;                  ///< largest tested additional delay with a stable loop
  double gain = 1;                           ///< largest tested factor of the volts with a stable loop
  bool survives_changes = false;             ///< cable and load: stable; friction: no stop
  std::optional<double> changed_settling_s;  ///< worst mean settling time under the changes; nothing: not all
                                             ///< changes settle
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
  /// True when the result of every maneuver of the case is true. @param number  of the case
  [[nodiscard]] bool all(const std::vector<bool>& results, std::size_t number) const;

  std::size_t maneuvers_;
  std::vector<bool> stable_, complete_;
  std::vector<std::optional<double>> settling_;
};

}  // namespace crane::tuning
