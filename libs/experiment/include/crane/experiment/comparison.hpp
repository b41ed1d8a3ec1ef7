#pragma once
/// Many runs side by side: every controller on every scenario in every variant. Same runs, same bytes.
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crane/experiment/metrics.hpp"
#include "crane/report/page.hpp"

namespace crane::experiment {

struct ComparedRun {
  std::string scenario, variant, controller;  ///< variant as in variant.hpp; empty: the rig as it is
  std::string scenario_description;
  std::string
      stopped_because;  ///< why the supervisor stopped the crane, or why it did not begin; empty: completed
  std::optional<Metrics> metrics;  ///< nothing when the run ended before its last move or kick
  std::vector<Sample> samples;     ///< up to where the run ended
};

/// Text columns scenario, variant, controller, stopped_because; then the keys of to_json(Metrics). Figures
/// that a run does not have are empty.
void write_comparison_csv(std::ostream& out, std::span<const ComparedRun> runs);

/// The same as an array of objects, absent figures null.
[[nodiscard]] nlohmann::ordered_json comparison_json(std::span<const ComparedRun> runs);

/// Per scenario a table of settling times, controllers by variants.
void write_comparison_summary(std::ostream& out, std::span<const ComparedRun> runs);
/// That, then the figures of every run.
void write_comparison_markdown(std::ostream& out, std::span<const ComparedRun> runs);

/// The tables of the Markdown file, and per scenario and variant the overlaid positions, swings and volts of
/// all controllers. Every second tick is drawn.
[[nodiscard]] report::Page comparison_page(std::span<const ComparedRun> runs, const std::string& rig);

}  // namespace crane::experiment
