#include "crane/experiment/comparison.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <utility>

#include "comparison_tables.hpp"
#include "crane/experiment/variant.hpp"
#include "metrics_cells.hpp"

namespace crane::experiment {
namespace {

/// Quotes a text for a CSV cell.
std::string text_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? "\"\"" : std::string{c};
  return cell + '"';
}

/// @param unit_s  time that counts as 1
std::string settling_cell(const ComparedRun& run, double unit_s) {
  if (!run.stopped_because.empty()) return run.stopped_because;
  return run.metrics && run.metrics->settling_time_s ? fixed(*run.metrics->settling_time_s / unit_s, 2) : "-";
}

std::optional<double> least_time_of(std::span<const ComparedRun> runs, const std::string& scenario) {
  for (const ComparedRun& run : runs)
    if (run.scenario == scenario) return run.least_settling_time_s;
  return std::nullopt;
}

/// Escapes '|', which would end the cell.
std::string markdown_cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

/// Writes a table with aligned columns, which is also readable on a terminal.
void write_markdown(std::ostream& out, const TextTable& table) {
  std::vector<std::size_t> widths(table.header.size(), 3);
  const auto widen = [&widths](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      widths[i] = std::max(widths[i], markdown_cell(cells[i]).size());
  };
  widen(table.header);
  for (const auto& row : table.rows) widen(row);
  const auto line = [&](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string cell = markdown_cell(cells[i]), blanks(widths[i] - cell.size(), ' ');
      out << "| " << (i == 0 ? cell + blanks : blanks + cell) << ' ';
    }
    out << "|\n";
  };
  line(table.header);
  for (std::size_t i = 0; i < widths.size(); ++i)
    out << "| " << std::string(widths[i] - (i == 0 ? 0 : 1), '-') << (i == 0 ? " " : ": ");
  out << "|\n";
  for (const auto& row : table.rows) line(row);
  out << '\n';
}

}  // namespace

std::string csv_cell(const nlohmann::ordered_json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return text_cell(value.get<std::string>());
  return value.is_number_float() ? recording::shortest(value.get<double>()) : value.dump();
}

std::string variant_title(const std::string& variant) {
  return variant.empty() ? "as the rig file says" : variant;
}

std::string variant_summary(const std::string& variant) {
  std::string summary;
  for (std::size_t begin = 0; begin < variant.size();) {
    const std::size_t end = std::min(variant.find('+', begin), variant.size());
    const std::string name = variant.substr(begin, end - begin);
    const auto found =
        std::find_if(variants().begin(), variants().end(), [&](const Variant& v) { return v.name == name; });
    if (found != variants().end()) summary += (summary.empty() ? "" : "; ") + std::string{found->summary};
    begin = end + 1;
  }
  return summary;
}

std::vector<std::string> distinct(std::span<const ComparedRun> runs, std::string ComparedRun::*member) {
  std::vector<std::string> values;
  for (const ComparedRun& run : runs)
    if (std::find(values.begin(), values.end(), run.*member) == values.end()) values.push_back(run.*member);
  return values;
}

std::vector<const ComparedRun*> runs_of(std::span<const ComparedRun> runs, const std::string& scenario,
                                        const std::string& variant) {
  std::vector<const ComparedRun*> found;
  for (const ComparedRun& run : runs)
    if (run.scenario == scenario && run.variant == variant) found.push_back(&run);
  return found;
}

TextTable settling_table(std::span<const ComparedRun> runs, const std::string& scenario, double unit_s) {
  TextTable table{.header = {"controller"}, .rows = {}};
  std::vector<std::string> columns;
  for (const std::string& variant : distinct(runs, &ComparedRun::variant))
    if (!runs_of(runs, scenario, variant).empty()) columns.push_back(variant);
  for (const std::string& variant : columns) table.header.push_back(variant_title(variant));
  for (const std::string& controller : distinct(runs, &ComparedRun::controller)) {
    std::vector<std::string> row{controller};
    bool any = false;
    for (const std::string& variant : columns) {
      const auto found = runs_of(runs, scenario, variant);
      const auto run = std::find_if(found.begin(), found.end(),
                                    [&](const ComparedRun* r) { return r->controller == controller; });
      row.push_back(run == found.end() ? "" : settling_cell(**run, unit_s));
      any = any || run != found.end();
    }
    if (any) table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable figures_table(const std::vector<const ComparedRun*>& runs) {
  TextTable table{.header = {"controller"}, .rows = {}};
  table.header.insert(table.header.end(), kMetricsHeader.begin(), kMetricsHeader.end());
  for (const char* text : {"trolley energy [V^2 s]", "slew energy [V^2 s]", "stopped by the supervisor"})
    table.header.emplace_back(text);
  for (const ComparedRun* run : runs) {
    std::vector<std::string> row{run->controller};
    if (run->metrics) {
      for (std::string& cell : metrics_cells(*run->metrics)) row.push_back(std::move(cell));
      row.push_back(fixed(run->metrics->effort_v2s[plant::kTrolley], 2));
      row.push_back(fixed(run->metrics->effort_v2s[plant::kSlew], 2));
    } else {
      row.resize(table.header.size() - 1);
    }
    row.push_back(run->stopped_because);
    table.rows.push_back(std::move(row));
  }
  return table;
}

nlohmann::ordered_json comparison_json(std::span<const ComparedRun> runs) {
  auto rows = nlohmann::ordered_json::array();
  for (const ComparedRun& run : runs) {
    nlohmann::ordered_json row{{"scenario", run.scenario},
                               {"variant", run.variant},
                               {"controller", run.controller},
                               {"stopped_because", run.stopped_because}};
    auto figures = to_json(run.metrics.value_or(Metrics{}));
    for (const auto& [key, value] : figures.items()) row[key] = run.metrics ? value : nullptr;
    rows.push_back(std::move(row));
  }
  return rows;
}

void write_comparison_csv(std::ostream& out, std::span<const ComparedRun> runs) {
  bool first = true;
  const auto next = [&first, &out] { out << (std::exchange(first, false) ? "" : ","); };
  for (const auto& row : comparison_json(std::vector<ComparedRun>(1)))
    for (const auto& [key, value] : row.items()) {
      next();
      out << key;
    }
  out << '\n';
  for (const auto& row : comparison_json(runs)) {
    first = true;
    for (const auto& [key, value] : row.items()) {
      next();
      out << csv_cell(value);
    }
    out << '\n';
  }
}

void write_comparison_summary(std::ostream& out, std::span<const ComparedRun> runs) {
  for (const std::string& scenario : distinct(runs, &ComparedRun::scenario)) {
    out << "## " << scenario << ": settling time [s]\n\n";
    write_markdown(out, settling_table(runs, scenario));
    const auto least_s = least_time_of(runs, scenario);
    if (!least_s) continue;
    out << "## " << scenario << ": settling time / least time of " << fixed(*least_s, 3) << " s\n\n";
    write_markdown(out, settling_table(runs, scenario, *least_s));
  }
}

void write_comparison_markdown(std::ostream& out, std::span<const ComparedRun> runs) {
  out << "# Comparison of controllers\n\n";
  write_comparison_summary(out, runs);
  for (const std::string& scenario : distinct(runs, &ComparedRun::scenario))
    for (const std::string& variant : distinct(runs, &ComparedRun::variant)) {
      const auto found = runs_of(runs, scenario, variant);
      if (found.empty()) continue;
      out << "## " << scenario << ", " << variant_title(variant) << "\n\n";
      if (const auto summary = variant_summary(variant); !summary.empty()) out << summary << ".\n\n";
      write_markdown(out, figures_table(found));
    }
}

}  // namespace crane::experiment
