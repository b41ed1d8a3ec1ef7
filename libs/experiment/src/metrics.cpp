#include "crane/experiment/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "crane/fields/angle.hpp"
#include "crane/plant/coordinates.hpp"

namespace crane::experiment {
namespace {

using plant::kAxes;

bool is_moved(const Maneuver& maneuver, std::size_t axis) { return maneuver.to[axis] != maneuver.from[axis]; }

/// Distance from the target within which an axis counts as settled; infinite for an unmoved hoist.
double tolerance(const Maneuver& maneuver, std::size_t axis) {
  if (is_moved(maneuver, axis)) return kSettlingShare * std::abs(maneuver.to[axis] - maneuver.from[axis]);
  constexpr plant::PerAxis kNominal{kNominalTrolleyMove_m, kNominalSlewMove_rad,
                                    std::numeric_limits<double>::infinity()};
  return kSettlingShare * kNominal[axis];
}

/// A sample with NaN counts as not settled.
bool has_arrived(const Sample& sample, const Maneuver& maneuver) {
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const double limit = tolerance(maneuver, axis);
    if (std::isinf(limit)) continue;
    if (!(std::abs(sample.position[axis] - maneuver.to[axis]) <= limit)) return false;
  }
  return std::abs(sample.swing_radial_rad) < kSettlingSwing_rad &&
         std::abs(sample.swing_tangential_rad) < kSettlingSwing_rad;
}

std::optional<double> settling_time(std::span<const Sample> after, const Maneuver& maneuver) {
  for (std::size_t i = after.size(); i-- > 0;) {
    if (has_arrived(after[i], maneuver)) continue;
    if (after.back().time_s - after[i].time_s <= kSettlingHold_s) return std::nullopt;
    return after[i + 1].time_s - maneuver.last_action_s;
  }
  return 0.0;
}

void fill_overshoot(std::span<const Sample> after, const Maneuver& maneuver, Metrics& metrics) {
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const double move = maneuver.to[axis] - maneuver.from[axis];
    double beyond = 0, deviation = 0;
    for (const Sample& sample : after) {
      const double error = sample.position[axis] - maneuver.to[axis];
      beyond = std::max(beyond, error * (move > 0 ? 1 : -1));
      deviation = std::max(deviation, std::abs(error));
    }
    if (is_moved(maneuver, axis))
      metrics.overshoot_percent[axis] = 100 * beyond / std::abs(move);
    else
      metrics.deviation[axis] = deviation;
    metrics.final_error[axis] = after.back().position[axis] - maneuver.to[axis];
  }
}

void fill_swing(std::span<const Sample> run, Metrics& metrics) {
  for (const Sample& sample : run) {
    const double radial = std::abs(sample.swing_radial_rad);
    const double tangential = std::abs(sample.swing_tangential_rad);
    metrics.largest_swing_radial_rad = std::max(metrics.largest_swing_radial_rad, radial);
    metrics.largest_swing_tangential_rad = std::max(metrics.largest_swing_tangential_rad, tangential);
    if (sample.time_s >= run.back().time_s - kResidualWindow_s)
      metrics.residual_swing_rad = std::max({metrics.residual_swing_rad, radial, tangential});
  }
}

void fill_swing_scatter(std::span<const Sample> after, Metrics& metrics) {
  const auto count = static_cast<double>(after.size());
  double radial = 0, tangential = 0;
  for (const Sample& sample : after)
    radial += sample.swing_radial_rad / count, tangential += sample.swing_tangential_rad / count;
  double squares = 0;
  for (const Sample& sample : after)
    squares +=
        std::pow(sample.swing_radial_rad - radial, 2) + std::pow(sample.swing_tangential_rad - tangential, 2);
  metrics.swing_scatter_rad = std::sqrt(squares / count);
}

void fill_volts(std::span<const Sample> run, Metrics& metrics) {
  for (std::size_t i = 0; i < run.size(); ++i)
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const double volts = run[i].drive_v[axis];
      metrics.largest_v[axis] = std::max(metrics.largest_v[axis], std::abs(volts));
      if (i + 1 < run.size()) metrics.effort_v2s[axis] += volts * volts * (run[i + 1].time_s - run[i].time_s);
    }
}

std::uint64_t lost_ticks(std::span<const Sample> run) {
  std::uint64_t lost = 0;
  for (std::size_t i = 1; i < run.size(); ++i)
    if (run[i].tick > run[i - 1].tick + 1) lost += run[i].tick - run[i - 1].tick - 1;
  return lost;
}

std::span<const Sample> from_time(std::span<const Sample> run, double time_s) {
  const auto first =
      std::find_if(run.begin(), run.end(), [=](const Sample& s) { return s.time_s >= time_s; });
  return run.subspan(static_cast<std::size_t>(first - run.begin()));
}

void require_usable(std::span<const Sample> run, const Maneuver& maneuver) {
  for (std::size_t i = 1; i < run.size(); ++i)
    if (!(run[i].time_s > run[i - 1].time_s))
      throw std::invalid_argument("time does not increase after " + recording::shortest(run[i - 1].time_s) +
                                  " s");
  if (run.empty() || !(run.back().time_s >= maneuver.last_action_s))
    throw std::invalid_argument("the run ends before its last move, excitation or kick at " +
                                recording::shortest(maneuver.last_action_s) + " s");
}

nlohmann::ordered_json or_null(const std::optional<double>& value, double scale = 1) {
  return value ? nlohmann::ordered_json(*value * scale) : nlohmann::ordered_json(nullptr);
}

/// Moves of the scenario in order of time; an excitation counts as a move to its mean position.
std::vector<Move> moves_of(const Scenario& scenario) {
  std::vector<Move> moves = scenario.moves;
  for (const Excitation& excitation : scenario.excitations) {
    Move move{.at_s = excitation.at_s, .target = {}};
    move.target[excitation.reference.axis] = excitation.reference.mean_position;
    moves.push_back(move);
  }
  std::ranges::stable_sort(moves, {}, &Move::at_s);
  return moves;
}

}  // namespace

std::vector<Sample> samples_from(const recording::Table& table) {
  using plant::kCoordinates;
  const std::vector<double>* time = table.find("time_s");
  if (time == nullptr) throw std::invalid_argument("the table has no column time_s");
  std::vector<Sample> samples(table.rows());
  const auto fill = [&](const std::string& column, auto&& place) {
    const std::vector<double>* values = table.find(column);
    for (std::size_t row = 0; values != nullptr && row < samples.size(); ++row)
      place(samples[row]) = (*values)[row];
  };
  const auto per_axis = [&](const char* plant::Coordinate::*column, plant::PerAxis Sample::*member) {
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      fill(kCoordinates[axis].*column, [=](Sample& sample) -> double& { return (sample.*member)[axis]; });
  };
  fill("time_s", [](Sample& sample) -> double& { return sample.time_s; });
  fill(kCoordinates[plant::kSwingRadial].column,
       [](Sample& sample) -> double& { return sample.swing_radial_rad; });
  fill(kCoordinates[plant::kSwingTangential].column,
       [](Sample& sample) -> double& { return sample.swing_tangential_rad; });
  per_axis(&plant::Coordinate::column, &Sample::position);
  per_axis(&plant::Coordinate::reference, &Sample::reference);
  per_axis(&plant::Coordinate::command_v, &Sample::drive_v);
  const std::vector<double>* ticks = table.find("tick");
  for (std::size_t row = 0; row < samples.size(); ++row)
    samples[row].tick = ticks == nullptr ? row : static_cast<std::uint64_t>((*ticks)[row]);
  return samples;
}

Maneuver maneuver_of(const Scenario& scenario, const configuration::Rig& rig) {
  Maneuver maneuver;
  maneuver.first_action_s = scenario.first_action_s();
  maneuver.last_action_s = scenario.last_action_s();
  maneuver.to = with_start_of(rig, scenario).start.position;
  maneuver.from = maneuver.to;
  const std::vector<Move> moves = moves_of(scenario);
  for (const Move& move : moves) {
    maneuver.from = maneuver.to;
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      maneuver.to[axis] = move.target[axis].value_or(maneuver.to[axis]);
  }
  // After the last move, a kick finds all axes at their targets: no axis counts as moved.
  if (!moves.empty() && scenario.last_action_s() > moves.back().at_s) maneuver.from = maneuver.to;
  return maneuver;
}

Metrics evaluate(std::span<const Sample> run, const Maneuver& maneuver) {
  require_usable(run, maneuver);
  const std::span<const Sample> after_first = from_time(run, maneuver.first_action_s);
  const std::span<const Sample> after_last = from_time(run, maneuver.last_action_s);
  Metrics metrics;
  metrics.settling_time_s = settling_time(after_last, maneuver);
  fill_overshoot(after_last, maneuver, metrics);
  fill_swing(after_first, metrics);
  fill_swing_scatter(after_last, metrics);
  fill_volts(after_first, metrics);
  metrics.lost_ticks = lost_ticks(run);
  return metrics;
}

nlohmann::ordered_json to_json(const Metrics& m) {
  using fields::kDegPerRad;
  return {{"settling_time_s", or_null(m.settling_time_s)},
          {"trolley_overshoot_percent", or_null(m.overshoot_percent[0])},
          {"slew_overshoot_percent", or_null(m.overshoot_percent[1])},
          {"hoist_overshoot_percent", or_null(m.overshoot_percent[2])},
          {"trolley_deviation_m", or_null(m.deviation[0])},
          {"slew_deviation_deg", or_null(m.deviation[1], kDegPerRad)},
          {"hoist_deviation_m", or_null(m.deviation[2])},
          {"trolley_final_error_m", m.final_error[0]},
          {"slew_final_error_deg", m.final_error[1] * kDegPerRad},
          {"hoist_final_error_m", m.final_error[2]},
          {"largest_swing_radial_deg", m.largest_swing_radial_rad * kDegPerRad},
          {"largest_swing_tangential_deg", m.largest_swing_tangential_rad * kDegPerRad},
          {"residual_swing_deg", m.residual_swing_rad * kDegPerRad},
          {"swing_scatter_deg", m.swing_scatter_rad * kDegPerRad},
          {"trolley_largest_v", m.largest_v[0]},
          {"slew_largest_v", m.largest_v[1]},
          {"hoist_largest_v", m.largest_v[2]},
          {"trolley_effort_v2s", m.effort_v2s[0]},
          {"slew_effort_v2s", m.effort_v2s[1]},
          {"hoist_effort_v2s", m.effort_v2s[2]},
          {"lost_ticks", m.lost_ticks}};
}

}  // namespace crane::experiment
