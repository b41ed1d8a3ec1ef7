#pragma once
/// Comparison of many runs: every controller with every scenario and every variant. Equal runs give equal
/// bytes.
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crane/experiment/metrics.hpp"
#include "crane/report/page.hpp"

namespace crane::experiment {

struct ComparedRun {
  /// variant: name of variant.hpp; empty: the rig file as written
  std::string scenario, variant, controller;
  std::string scenario_description;
  /// Cause with which the supervisor stopped the crane or refused to start; empty: the run is complete.
  std::string stopped_because;
  std::optional<Metrics> metrics;                 ///< nothing when the run ended before its last move or kick
  std::vector<Sample> samples;                    ///< all samples up to the end of the run
  std::optional<double> least_settling_time_s{};  ///< of the scenario
};

/// Writes CSV with the text columns scenario, variant, controller, stopped_because, followed by the keys of
/// to_json(Metrics). Missing figures are empty cells.
void write_comparison_csv(std::ostream& out, std::span<const ComparedRun> runs);

/// A value as a cell of a CSV file: a number as the shortest text that gives the same double when read, a
/// text with quotes if necessary, null as an empty cell.
[[nodiscard]] std::string csv_cell(const nlohmann::ordered_json& value);

/// The same data as an array of objects; missing figures are null.
[[nodiscard]] nlohmann::ordered_json comparison_json(std::span<const ComparedRun> runs);

/// Writes for each scenario a table of settling times, and one of their ratios to the least time when the
/// scenario has one; rows are controllers, columns are variants.
void write_comparison_summary(std::ostream& out, std::span<const ComparedRun> runs);
/// Writes the summary and the figures of every run.
void write_comparison_markdown(std::ostream& out, std::span<const ComparedRun> runs);

/// Page with the tables of the Markdown file, and for each scenario and variant plots of positions, swings
/// and volts of all controllers. The plots show every second tick.
[[nodiscard]] report::Page comparison_page(std::span<const ComparedRun> runs, const std::string& rig);

}  // namespace crane::experiment
