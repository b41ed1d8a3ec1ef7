/// tune.json, tuned.toml and tune.html.
#include <cmath>
#include <nlohmann/json.hpp>

#include "crane/fields/angle.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/report/page.hpp"
#include "tuning/drawn_rigs.hpp"
#include "tuning/tune.hpp"

namespace crane::tuning {
namespace {

using nlohmann::ordered_json;

ordered_json or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json to_json(const Entry& entry, const std::vector<std::string>& maneuvers) {
  ordered_json json{{"controller", entry.candidate.controller}};
  for (const auto& [key, value] : entry.candidate.gains) json["gains"][key] = value;
  json["swing_observer"] = entry.candidate.observer;
  json["mean_settling_s"] = or_null(entry.mean_settling_s);
  for (std::size_t i = 0; i < maneuvers.size(); ++i)
    json["settling_s"][maneuvers[i]] = or_null(entry.settling_s[i]);
  json["largest_swing_deg"] = entry.largest_swing_rad * fields::kDegPerRad;
  if (!entry.stopped_because.empty()) json["stopped_because"] = entry.stopped_because;
  if (entry.margins)
    json["margins"] = {{"delay_periods", entry.margins->delay_periods},
                       {"gain", entry.margins->gain},
                       {"survives_changes", entry.margins->survives_changes},
                       {"changed_settling_s", or_null(entry.margins->changed_settling_s)}};
  if (entry.predicted)
    json["predicted_settling_s"] = {{"mean", entry.predicted->mean_s},
                                    {"least", entry.predicted->least_s},
                                    {"largest", entry.predicted->largest_s}};
  return json;
}

report::Cell seconds(const std::optional<double>& value) {
  return value ? report::number(*value, 2) : report::Cell{"does not settle", report::Tone::muted};
}

/// Predicted settling time with the range of the drawn rigs.
std::string text_of(const Predicted& predicted) {
  const auto rounded = [](double value_s) { return recording::shortest(std::round(100 * value_s) / 100); };
  return rounded(predicted.mean_s) + " (" + rounded(predicted.least_s) + " to " +
         rounded(predicted.largest_s) + ")";
}

report::Section ranking(const Recommendation& recommendation) {
  report::Table table{.title = "", .header = {"law"}, .rows = {}};
  for (const auto& maneuver : recommendation.maneuvers) table.header.push_back(maneuver + " [s]");
  for (const char* name : {"mean [s]", "delay margin [periods]", "gain margin", "changed rig, worst mean [s]",
                           "drawn rigs, mean (range) [s]"})
    table.header.emplace_back(name);
  for (std::size_t i = 0; i < recommendation.entries.size(); ++i) {
    const Entry& entry = recommendation.entries[i];
    const bool wins = recommendation.winner == i;
    std::vector<report::Cell> row{
        {entry.candidate.label(), wins ? report::Tone::good : report::Tone::neutral}};
    for (const auto& time : entry.settling_s) row.push_back(seconds(time));
    row.push_back(seconds(entry.mean_settling_s));
    if (entry.margins) {
      const auto& margins = *entry.margins;
      row.push_back(report::number(
          margins.delay_periods, 0,
          margins.delay_periods < kRequiredDelay_periods ? report::Tone::bad : report::Tone::neutral));
      row.push_back(report::number(margins.gain, 1,
                                   margins.gain < kRequiredGain ? report::Tone::bad : report::Tone::neutral));
      row.push_back(margins.survives_changes ? seconds(margins.changed_settling_s)
                                             : report::Cell{"unstable", report::Tone::bad});
      if (margins.holds())
        row.push_back(entry.predicted ? report::Cell{text_of(*entry.predicted), report::Tone::neutral}
                                      : report::Cell{"does not settle", report::Tone::bad});
    }
    table.rows.push_back(std::move(row));
  }
  return {.title = "Laws and gains", .blocks = {std::move(table)}};
}

report::Section estimates(const TuneResult& result) {
  report::Table table{.title = "", .header = {"parameter", "unit", "value", "standard error"}, .rows = {}};
  for (const auto& [name, unit, value] : named_values(result.identification.values))
    table.rows.push_back({{name, report::Tone::neutral},
                          {unit, report::Tone::neutral},
                          report::number(value.value, 5),
                          report::number(value.standard_error, 5)});
  return {.title = "Identified rig", .blocks = {std::move(table)}};
}

/// Thins the values to at most kPoints, so that the page stays small.
std::vector<double> thinned(const std::vector<double>& values) {
  constexpr std::size_t kPoints = 4000;
  const std::size_t step = values.size() / kPoints + 1;
  std::vector<double> few;
  for (std::size_t i = 0; i < values.size(); i += step) few.push_back(values[i]);
  return few;
}

report::Section motion_section(const recording::Table& motion, const configuration::Rig& rig) {
  report::Section section{.title = "Motion", .blocks = {}};
  const auto add = [&](const std::string& title, const std::string& unit,
                       const std::vector<std::string>& columns) {
    report::LinePlot plot{.title = title,
                          .x_label = "time [s]",
                          .y_label = unit,
                          .x = thinned(*motion.find("time_s")),
                          .series = {},
                          .group = "motion"};
    for (const auto& name : columns)
      if (const auto* values = motion.find(name))
        plot.series.push_back({.name = name, .x = {}, .y = thinned(*values), .upper = {}});
    if (!plot.series.empty()) section.blocks.emplace_back(std::move(plot));
  };
  const bool slews = rig.drives[plant::kSlew].present;
  const auto& names = plant::kCoordinates;
  add("voltage", "V",
      slews ? std::vector<std::string>{names[0].command_v, names[1].command_v}
            : std::vector<std::string>{names[0].command_v});
  add("trolley", "m", {names[plant::kTrolley].column});
  if (slews) add("slew", "rad", {names[plant::kSlew].column});
  add("swing", "rad",
      slews
          ? std::vector<std::string>{names[plant::kSwingRadial].column, names[plant::kSwingTangential].column}
          : std::vector<std::string>{names[plant::kSwingRadial].column});
  return section;
}

}  // namespace

ordered_json to_json(const TuneResult& result, const configuration::Rig& rig) {
  ordered_json json{{"rig", rig.name}, {"motion_s", result.motion_s}};
  for (const auto& [name, unit, value] : named_values(result.identification.values))
    json["identified"][name] = {{"value", value.value}, {"std", value.standard_error}, {"unit", unit}};
  json["swing_residual_rad"] = result.identification.swing_residual_rad;
  json["trolley_residual_m"] = result.identification.drive_residual[plant::kTrolley];
  if (rig.drives[plant::kSlew].present)
    json["slew_residual_rad"] = result.identification.drive_residual[plant::kSlew];
  const auto& recommendation = result.recommendation;
  json["required_margins"] = {{"delay_periods", kRequiredDelay_periods}, {"gain", kRequiredGain}};
  json["drawn_rigs"] = {{"count", kDrawnRigs}, {"seed", result.seed}};
  if (recommendation.winner)
    json["recommended"] = to_json(recommendation.entries[*recommendation.winner], recommendation.maneuvers);
  for (const auto& entry : recommendation.entries)
    json["ranking"].push_back(to_json(entry, recommendation.maneuvers));
  return json;
}

std::string rig_text(const TuneResult& result) {
  std::string text = "# " + result.tuned.name + ", identified and tuned by crane tune from " +
                     result.tuned.path + ". Standard errors:\n";
  for (const auto& [name, unit, value] : named_values(result.identification.values))
    text += "#   " + name + " = " + recording::shortest(value.value) + " +- " +
            recording::shortest(value.standard_error) + ' ' + unit + '\n';
  return text + configuration::to_toml(result.tuned);
}

report::Page page_of(const TuneResult& result, const configuration::Rig& rig,
                     const recording::Table& motion) {
  const auto& recommendation = result.recommendation;
  report::Page page{.title = "Tuning of " + rig.name,
                    .summary = recording::shortest(std::round(result.motion_s)) + " s of motion.",
                    .sections = {}};
  if (recommendation.winner) {
    const Entry& best = recommendation.entries[*recommendation.winner];
    page.sections.push_back(
        {.title = "Recommendation",
         .blocks = {report::Verdict{
             .text = best.candidate.label() + ": predicted settling time " + text_of(*best.predicted) +
                     " s, mean over the maneuvers; the range covers the identified rig and " +
                     std::to_string(kDrawnRigs) +
                     " rigs drawn from the standard errors. Delay margin at least " +
                     recording::shortest(best.margins->delay_periods) + " periods, gain margin at least " +
                     recording::shortest(best.margins->gain) + ".",
             .tone = report::Tone::good}}});
  }
  page.sections.push_back(estimates(result));
  page.sections.push_back(ranking(recommendation));
  page.sections.push_back(motion_section(motion, rig));
  return page;
}

}  // namespace crane::tuning
