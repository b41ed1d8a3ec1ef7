#include <algorithm>
#include <array>
#include <cstdio>
#include <ostream>

#include "metrics_cells.hpp"

#include "crane/fields/angle.hpp"

namespace crane::experiment {
namespace {

using fields::kDegPerRad;
using Row = std::vector<std::string>;

/// Overshoot of a moved axis, "14.3 %"; deviation of an unmoved axis, "17.4 cm" or "2.1 deg".
std::string overshoot(const Metrics& metrics, std::size_t axis) {
  if (metrics.overshoot_percent[axis]) return fixed(*metrics.overshoot_percent[axis], 1) + " %";
  const double deviation = metrics.deviation[axis].value_or(0);
  return axis == plant::kSlew ? fixed(deviation * kDegPerRad, 1) + " deg" : fixed(deviation * 100, 1) + " cm";
}

constexpr std::size_t kTextColumns = 2;  // aligned left, the others right

std::string padded(const std::string& cell, std::size_t width, bool left) {
  const std::string blanks(width - cell.size(), ' ');
  return left ? cell + blanks : blanks + cell;
}

Row row_of(const NamedMetrics& run) {
  Row row{run.scenario, run.controller};
  for (std::string& cell : metrics_cells(run.metrics)) row.push_back(std::move(cell));
  return row;
}

Row header() {
  Row row{"scenario", "controller"};
  row.insert(row.end(), kMetricsHeader.begin(), kMetricsHeader.end());
  return row;
}

}  // namespace

std::string fixed(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::vector<std::string> metrics_cells(const Metrics& m) {
  return {m.settling_time_s ? fixed(*m.settling_time_s, 2) : "-",
          overshoot(m, plant::kTrolley),
          overshoot(m, plant::kSlew),
          fixed(m.largest_swing_radial_rad * kDegPerRad, 1),
          fixed(m.largest_swing_tangential_rad * kDegPerRad, 1),
          fixed(m.residual_swing_rad * kDegPerRad, 2),
          fixed(m.largest_v[plant::kTrolley], 1),
          fixed(m.largest_v[plant::kSlew], 1),
          std::to_string(m.lost_ticks)};
}

void print_table(std::ostream& out, std::span<const NamedMetrics> runs, TableStyle style) {
  std::vector<Row> rows{header()};
  for (const NamedMetrics& run : runs) rows.push_back(row_of(run));
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  const bool markdown = style == TableStyle::markdown;
  const auto print = [&](const Row& row) {
    std::string line = markdown ? "| " : "";
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) line += markdown ? " | " : "  ";
      line += padded(row[i], widths[i], i < kTextColumns);
    }
    out << line << (markdown ? " |\n" : "\n");
  };
  print(rows.front());
  Row rule;
  for (std::size_t i = 0; i < widths.size(); ++i)
    rule.push_back(std::string(widths[i] - (markdown && i >= kTextColumns ? 1 : 0), '-') +
                   (markdown && i >= kTextColumns ? ":" : ""));
  print(rule);
  for (std::size_t i = 1; i < rows.size(); ++i) print(rows[i]);
}

}  // namespace crane::experiment
