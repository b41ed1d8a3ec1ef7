#pragma once
/// Figures of merit of one maneuver: settling time, overshoot, swing, volts. Pure functions.
#include <array>
#include <cstdint>
#include <iosfwd>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crane/experiment/scenario.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/recording/csv.hpp"

namespace crane::experiment {

/// One tick of a run. Time counts from the moment the crane holds, as in the scenario.
struct Sample {
  double time_s = 0;
  std::uint64_t tick = 0;
  plant::PerAxis position{};   ///< m, rad, m of cable
  plant::PerAxis reference{};  ///< NaN when none was published
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  plant::PerAxis drive_v{};  ///< applied from this tick on
};

/// Rows of recording::RunTable; columns the table lacks stay 0, a missing `tick` counts the rows.
/// @throws std::invalid_argument without time_s
[[nodiscard]] std::vector<Sample> samples_from(const recording::Table& table);

/// What the run was asked to do.
struct Maneuver {
  double first_action_s = 0;  ///< figures are taken from here on
  double last_action_s = 0;   ///< settling time, overshoot are taken from here on
  plant::PerAxis from{};      ///< position asked for before the last move
  plant::PerAxis to{};        ///< position asked for at the end; axes with to = from are unmoved
};
/// @param rig where the axes start that the scenario does not place
[[nodiscard]] Maneuver maneuver_of(const Scenario& scenario, const configuration::Rig& rig);

/// Share of a move within which an axis counts as arrived.
inline constexpr double kSettlingShare = 0.02;
/// Moves of the dissertation (4.5.1); an unmoved trolley or slew axis must stay within the share of these.
inline constexpr double kNominalTrolleyMove_m = 0.75;
inline constexpr double kNominalSlewMove_rad = 1.5707963267948966;
/// Both swing angles must stay below it: 0.5 degrees.
inline constexpr double kSettlingSwing_rad = 0.008726646259971648;
/// Arrived means at least so long before the end of the run: half a period of a 1 m cable, so that a swinging
/// load does not pass for settled because the run ends as it crosses the middle.
inline constexpr double kSettlingHold_s = 1;
/// The residual swing is taken over so much time at the end.
inline constexpr double kResidualWindow_s = 4;

struct Metrics {
  /// From the last action until every axis and both swings have arrived for good; nothing when they never do.
  /// Hoist counts only when moved.
  std::optional<double> settling_time_s;
  /// Per axis: % of the move beyond its target; nothing when unmoved.
  std::array<std::optional<double>, plant::kAxes> overshoot_percent;
  /// Per axis: largest |position - target| when unmoved (m, rad, m of cable); nothing when moved.
  std::array<std::optional<double>, plant::kAxes> deviation;
  plant::PerAxis final_error{};  ///< last position - target: m, rad, m of cable
  double largest_swing_radial_rad = 0, largest_swing_tangential_rad = 0;
  double residual_swing_rad = 0;  ///< largest of both angles in the last kResidualWindow_s
  plant::PerAxis largest_v{};
  plant::PerAxis effort_v2s{};   ///< integral of V^2, the voltage held from sample to sample
  std::uint64_t lost_ticks = 0;  ///< numbers missing between the first tick and the last
};

/// @throws std::invalid_argument when no sample is at or after first_action_s, or time does not increase
[[nodiscard]] Metrics evaluate(std::span<const Sample> run, const Maneuver& maneuver);

/// Angles in degrees (…_deg), absent figures null.
[[nodiscard]] nlohmann::ordered_json to_json(const Metrics& metrics);

/// One line of a comparison.
struct NamedMetrics {
  std::string scenario, controller;
  Metrics metrics;
};
enum class TableStyle { text, markdown };
/// One row per run: settling time, overshoot or deviation of trolley and slew, largest swings, residual
/// swing, largest volts.
void print_table(std::ostream& out, std::span<const NamedMetrics> runs, TableStyle style = TableStyle::text);

}  // namespace crane::experiment
