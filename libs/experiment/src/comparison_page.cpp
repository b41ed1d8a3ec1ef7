#include <algorithm>
#include <cmath>
#include <functional>

#include "comparison_tables.hpp"
#include "crane/experiment/comparison.hpp"
#include "crane/fields/angle.hpp"

namespace crane::experiment {
namespace {

using Value = std::function<double(const Sample&)>;

using fields::kDegPerRad;
// Ticks between drawn points: finer than the resolution of a screen; halves the size of the page.
constexpr std::size_t kDrawEvery = 2;
constexpr int kReferenceColor = 8;  // grey

struct PlotKind {
  const char* title;
  const char* unit;
  Value value;
  Value reference;  ///< may be empty
};

const std::vector<PlotKind>& plot_kinds() {
  using plant::kSlew;
  using plant::kTrolley;
  static const std::vector<PlotKind> kKinds{
      {"Trolley position", "m", [](const Sample& s) { return s.position[kTrolley]; },
       [](const Sample& s) { return s.reference[kTrolley]; }},
      {"Slew angle", "deg", [](const Sample& s) { return s.position[kSlew] * kDegPerRad; },
       [](const Sample& s) { return s.reference[kSlew] * kDegPerRad; }},
      {"Radial swing", "deg", [](const Sample& s) { return s.swing_radial_rad * kDegPerRad; }, {}},
      {"Tangential swing", "deg", [](const Sample& s) { return s.swing_tangential_rad * kDegPerRad; }, {}},
      {"Trolley drive", "V", [](const Sample& s) { return s.drive_v[kTrolley]; }, {}},
      {"Slew drive", "V", [](const Sample& s) { return s.drive_v[kSlew]; }, {}}};
  return kKinds;
}

std::vector<double> drawn(const std::vector<Sample>& samples, const Value& value) {
  std::vector<double> values;
  for (std::size_t i = 0; i < samples.size(); i += kDrawEvery) values.push_back(value(samples[i]));
  return values;
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double p, double q) { return p == q || (std::isnan(p) && std::isnan(q)); });
}

double time_of(const Sample& sample) { return sample.time_s; }

report::LinePlot plot_of(const std::vector<const ComparedRun*>& runs, const PlotKind& kind) {
  report::LinePlot plot{.title = kind.title,
                        .x_label = "time [s]",
                        .y_label = kind.unit,
                        .x = {},
                        .series = {},
                        .group = runs.front()->scenario};
  for (std::size_t i = 0; i < runs.size(); ++i)
    plot.series.push_back({.name = runs[i]->controller,
                           .x = drawn(runs[i]->samples, time_of),
                           .y = drawn(runs[i]->samples, kind.value),
                           .upper = {},
                           .color = static_cast<int>(i)});
  // The controllers use two references at most: step and bang-coast-bang.
  std::vector<std::vector<double>> references;
  for (const ComparedRun* run : runs) {
    if (!kind.reference) break;
    auto reference = drawn(run->samples, kind.reference);
    if (std::any_of(references.begin(), references.end(), [&](const auto& r) { return same(r, reference); }))
      continue;
    plot.series.push_back(
        {.name = "reference" + (references.empty() ? "" : " " + std::to_string(references.size() + 1)),
         .x = drawn(run->samples, time_of),
         .y = reference,
         .upper = {},
         .color = kReferenceColor,
         .dashed = true});
    references.push_back(std::move(reference));
  }
  return plot;
}

/// A cell of a settling table is a number, empty (not settled), or the cause of a stop.
report::Tone tone_of(const std::string& text) {
  if (text == "-") return report::Tone::bad;
  const bool reason = !text.empty() && (text[0] < '0' || text[0] > '9');
  return reason ? report::Tone::bad : report::Tone::neutral;
}

report::Table table_of(const std::string& title, const TextTable& texts, bool colored) {
  report::Table table{.title = title, .header = texts.header, .rows = {}};
  for (const auto& row : texts.rows) {
    std::vector<report::Cell> cells;
    for (const std::string& text : row)
      cells.push_back({text, colored && !cells.empty() ? tone_of(text) : report::Tone::neutral});
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace

report::Page comparison_page(std::span<const ComparedRun> runs, const std::string& rig) {
  report::Page page{.title = "Comparison of controllers",
                    .summary = "Rig " + rig + ", " + std::to_string(runs.size()) +
                               " runs. A run has settled when all axes stay within 2 % of the move and both "
                               "swings stay below 0.5 degrees until its end.",
                    .sections = {}};
  report::Section summary{.title = "Settling time [s]", .blocks = {}};
  const auto scenarios = distinct(runs, &ComparedRun::scenario);
  for (const std::string& scenario : scenarios)
    summary.blocks.emplace_back(table_of(scenario, settling_table(runs, scenario), true));
  page.sections.push_back(std::move(summary));
  for (const std::string& scenario : scenarios)
    for (const std::string& variant : distinct(runs, &ComparedRun::variant)) {
      const auto found = runs_of(runs, scenario, variant);
      if (found.empty()) continue;
      report::Section section{
          .title = scenario + ", " + variant_title(variant), .blocks = {}, .folded = true};
      section.blocks.emplace_back(report::Paragraph{found.front()->scenario_description});
      if (const auto text = variant_summary(variant); !text.empty())
        section.blocks.emplace_back(report::Paragraph{variant + ": " + text + "."});
      section.blocks.emplace_back(table_of("", figures_table(found), false));
      for (const PlotKind& kind : plot_kinds()) section.blocks.emplace_back(plot_of(found, kind));
      page.sections.push_back(std::move(section));
    }
  return page;
}

}  // namespace crane::experiment
