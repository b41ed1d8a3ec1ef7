#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "sweep/results.hpp"

namespace crane::sweep {
namespace {

std::string fixed(double value, int digits) {
  if (std::isnan(value)) return "-";
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string variant_of(const Group& group) { return group.variant.empty() ? "as_is" : group.variant; }

std::string most_frequent_stop(const Group& group) {
  const auto most = std::max_element(group.stops.begin(), group.stops.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == group.stops.end() ? "" : most->first;
}

const std::vector<std::string>& header() {
  static const std::vector<std::string> kHeader{"variant",       "controller",        "runs",
                                                "settled",       "stopped",           "settle, median [s]",
                                                "90 % [s]",      "slowest [s]",       "swing, median [deg]",
                                                "largest [deg]", "most frequent stop"};
  return kHeader;
}

std::vector<std::string> row_of(const Group& group) {
  return {
      variant_of(group),
      group.controller,
      std::to_string(group.runs),
      fixed(100.0 * static_cast<double>(group.settling_s.size()) / static_cast<double>(group.runs), 1) + " %",
      std::to_string(group.stopped),
      fixed(quantile(group.settling_s, 0.5), 2),
      fixed(quantile(group.settling_s, 0.9), 2),
      fixed(quantile(group.settling_s, 1), 2),
      fixed(quantile(group.largest_swing_deg, 0.5), 1),
      fixed(quantile(group.largest_swing_deg, 1), 1),
      most_frequent_stop(group)};
}

/// Share of the runs that have settled by a time, one line per group.
report::LinePlot distribution_of(const std::vector<const Group*>& groups) {
  report::LinePlot plot{.title = "Share of runs that have settled",
                        .x_label = "settling time [s]",
                        .y_label = "%",
                        .x = {},
                        .series = {},
                        .group = ""};
  for (const Group* group : groups) {
    if (group->settling_s.empty()) continue;
    report::Series series{
        .name = variant_of(*group) + ", " + group->controller, .x = {}, .y = {}, .upper = {}};
    for (std::size_t i = 0; i < group->settling_s.size(); ++i) {
      series.x.push_back(group->settling_s[i]);
      series.y.push_back(100.0 * static_cast<double>(i + 1) / static_cast<double>(group->runs));
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

std::string title_of(const Case& on) { return on.scenario.name + " on " + on.rig.name; }

}  // namespace

std::string summary_of(const std::vector<Group>& groups) {
  std::vector<std::vector<std::string>> rows{{"scenario and rig"}};
  rows[0].insert(rows[0].end(), header().begin(), header().end());
  for (const Group& group : groups) {
    rows.push_back({title_of(*group.on)});
    const auto cells = row_of(group);
    rows.back().insert(rows.back().end(), cells.begin(), cells.end());
  }
  std::vector<std::size_t> widths(rows[0].size());
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  constexpr std::size_t kTextColumns = 3;
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string blanks(widths[i] - row[i].size(), ' ');
      const bool left = i < kTextColumns || i + 1 == row.size();
      line += (i == 0 ? "" : "  ") + (left ? row[i] + blanks : blanks + row[i]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

report::Page page_of(const Sweep& sweep, const std::vector<Group>& groups) {
  report::Page page{.title = "Sweep " + sweep.name,
                    .summary = (sweep.description.empty() ? "" : sweep.description + " ") +
                               std::to_string(sweep.size()) +
                               " runs. A run has settled when all axes stay within 2 % of the move and both "
                               "swings stay below 0.5 degrees until its end.",
                    .sections = {}};
  if (!sweep.draws.empty()) {
    report::Table table{
        .title = "Drawn for each seed, uniformly", .header = {"key", "from", "to"}, .rows = {}};
    for (const Draw& draw : sweep.draws)
      table.rows.push_back({{draw.key}, {recording::shortest(draw.low)}, {recording::shortest(draw.high)}});
    page.sections.push_back({.title = "True cranes", .blocks = {table}});
  }
  for (const Case& on : sweep.cases) {
    report::Section section{.title = title_of(on), .blocks = {report::Paragraph{on.scenario.description}}};
    report::Table table{.title = "", .header = header(), .rows = {}};
    std::vector<const Group*> of_case;
    for (const Group& group : groups) {
      if (group.on != &on) continue;
      of_case.push_back(&group);
      std::vector<report::Cell> cells;
      for (const auto& text : row_of(group)) cells.push_back({text});
      if (group.stopped > 0) cells[4].tone = report::Tone::bad;
      table.rows.push_back(std::move(cells));
    }
    section.blocks.emplace_back(std::move(table));
    if (auto plot = distribution_of(of_case); !plot.series.empty())
      section.blocks.emplace_back(std::move(plot));
    page.sections.push_back(std::move(section));
  }
  return page;
}

}  // namespace crane::sweep
