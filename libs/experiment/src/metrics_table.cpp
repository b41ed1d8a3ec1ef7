#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>
#include <ostream>

#include "crane/experiment/metrics.hpp"

namespace crane::experiment {
namespace {

constexpr double kDeg = 180 / std::numbers::pi;
using Row = std::vector<std::string>;

std::string fixed(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

/// "14.3 %" of a moved axis, "17.4 cm" or "2.1 deg" of one that should not have moved.
std::string overshoot(const Metrics& metrics, std::size_t axis) {
  if (metrics.overshoot_percent[axis]) return fixed(*metrics.overshoot_percent[axis], 1) + " %";
  const double deviation = metrics.deviation[axis].value_or(0);
  return axis == plant::kSlew ? fixed(deviation * kDeg, 1) + " deg" : fixed(deviation * 100, 1) + " cm";
}

Row row_of(const NamedMetrics& run) {
  const Metrics& m = run.metrics;
  return {run.scenario,
          run.controller,
          m.settling_time_s ? fixed(*m.settling_time_s, 2) : "-",
          overshoot(m, plant::kTrolley),
          overshoot(m, plant::kSlew),
          fixed(m.largest_swing_radial_rad * kDeg, 1),
          fixed(m.largest_swing_tangential_rad * kDeg, 1),
          fixed(m.residual_swing_rad * kDeg, 2),
          fixed(m.largest_v[plant::kTrolley], 1),
          fixed(m.largest_v[plant::kSlew], 1),
          std::to_string(m.lost_ticks)};
}

const Row kHeader{"scenario",        "controller",         "settle [s]",       "trolley over",
                  "slew over",       "swing radial [deg]", "tangential [deg]", "residual [deg]",
                  "trolley max [V]", "slew max [V]",       "lost ticks"};
constexpr std::size_t kTextColumns = 2;  // aligned left, the others right

std::string padded(const std::string& cell, std::size_t width, bool left) {
  const std::string blanks(width - cell.size(), ' ');
  return left ? cell + blanks : blanks + cell;
}

}  // namespace

void print_table(std::ostream& out, std::span<const NamedMetrics> runs, TableStyle style) {
  std::vector<Row> rows{kHeader};
  for (const NamedMetrics& run : runs) rows.push_back(row_of(run));
  std::vector<std::size_t> widths(kHeader.size(), 0);
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
