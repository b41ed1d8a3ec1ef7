#pragma once
/// Computes figures of merit of one maneuver: settling time, overshoot, swing, volts. Pure functions. Source
/// of moves and limits: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003, section 4.5.1.
#include <array>
#include <cstdint>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crane/experiment/scenario.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/recording/csv.hpp"

namespace crane::experiment {

/// One tick of a run. Time 0 is the start of the run, as in the scenario.
struct Sample {
  double time_s = 0;
  std::uint64_t tick = 0;
  plant::PerAxis position{};   ///< m, rad, m of cable
  plant::PerAxis reference{};  ///< NaN when none was published
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  plant::PerAxis drive_v{};  ///< voltage that acts from this tick on
};

/// Converts the rows of recording::RunTable. Missing columns give 0; a missing column `tick` gives the row
/// number.
/// @throws std::invalid_argument without the column time_s
[[nodiscard]] std::vector<Sample> samples_from(const recording::Table& table);

/// Times and targets for the evaluation of a run. An "action" is a move, an excitation or a kick.
struct Maneuver {
  double first_action_s = 0;  ///< start of the evaluation
  double last_action_s = 0;   ///< start of the evaluation of settling time and overshoot
  plant::PerAxis from{};      ///< target position before the last move
  plant::PerAxis to{};        ///< final target position; an axis with to = from is unmoved
};
/// @param rig  gives the start position of each axis for which the scenario has none
[[nodiscard]] Maneuver maneuver_of(const Scenario& scenario, const configuration::Rig& rig);

/// A moved axis has settled when |position - target| stays within this share of its move.
inline constexpr double kSettlingShare = 0.02;
/// Moves of section 4.5.1. An unmoved trolley or slew axis has settled within kSettlingShare of these.
inline constexpr double kNominalTrolleyMove_m = 0.75;
inline constexpr double kNominalSlewMove_rad = 1.5707963267948966;
/// Limit for both swing angles: 0.5 degrees.
inline constexpr double kSettlingSwing_rad = 0.008726646259971648;
/// Shortest time at the end of a settled run for which it must stay settled: half the swing period with 1 m
/// of cable, so that a swinging load that passes its centre at the end of the run does not count as settled.
inline constexpr double kSettlingHold_s = 1;
/// Time at the end of the run over which the residual swing is computed.
inline constexpr double kResidualWindow_s = 4;

struct Metrics {
  /// Time from the last action until all axes and both swings have settled; nothing when they do not settle.
  /// An unmoved hoist is not considered.
  std::optional<double> settling_time_s;
  /// Overshoot of each moved axis, in % of its move; nothing for an unmoved axis.
  std::array<std::optional<double>, plant::kAxes> overshoot_percent;
  /// Largest |position - target| of each unmoved axis (m, rad, m of cable); nothing for a moved axis.
  std::array<std::optional<double>, plant::kAxes> deviation;
  plant::PerAxis final_error{};  ///< last position - target: m, rad, m of cable
  double largest_swing_radial_rad = 0, largest_swing_tangential_rad = 0;
  double residual_swing_rad = 0;  ///< largest angle of both swings in the last kResidualWindow_s
  /// Standard deviation of the swing from the last action on, both planes: sqrt(var(radial) +
  /// var(tangential)).
  double swing_scatter_rad = 0;
  plant::PerAxis largest_v{};    ///< largest |V|
  plant::PerAxis effort_v2s{};   ///< integral of V^2 over time; the voltage is constant between samples
  std::uint64_t lost_ticks = 0;  ///< number of missing ticks between the first and the last tick
};

/// @throws std::invalid_argument when the run ends before last_action_s, or time does not increase
[[nodiscard]] Metrics evaluate(std::span<const Sample> run, const Maneuver& maneuver);

/// Figures as JSON: angles in degrees (…_deg), missing figures null.
[[nodiscard]] nlohmann::ordered_json to_json(const Metrics& metrics);

/// One line of a comparison.
struct NamedMetrics {
  std::string scenario, controller;
  Metrics metrics;
};
enum class TableStyle { text, markdown };
/// Prints one row per run: settling time, overshoot or deviation of trolley and slew, largest swings,
/// residual swing, largest volts, lost ticks.
void print_table(std::ostream& out, std::span<const NamedMetrics> runs, TableStyle style = TableStyle::text);

}  // namespace crane::experiment
