#include "cli/scope_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/curves.hpp"

namespace crane::cli {
namespace {

using observation::Capture, observation::Field, observation::FieldTable;
using recording::LeafType;

constexpr std::size_t kLargestPanel = 10;  // rows of a curve
// Rows besides the panels: title, time axis, labels of the axis, file name, prompt.
constexpr std::size_t kFrame = 5;

/// Unit on the screen: degrees instead of radians.
struct Display {
  std::string unit;
  double factor = 1;
};

Display display_of(const LeafType& leaf) {
  const auto* const unit = fields::unit_with_symbol(leaf.unit);
  if (unit == nullptr || !leaf.unit.starts_with("rad")) return {leaf.unit};
  const auto* const degrees = fields::unit_with_symbol("deg" + leaf.unit.substr(3));
  if (degrees == nullptr) return {leaf.unit};
  return {std::string{degrees->symbol}, unit->factor / degrees->factor};
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", value);
  return text;
}

std::string value_text(const LeafType& leaf, double value) {
  const bool known = value >= 0 && value < static_cast<double>(leaf.enumerators.size());
  return known ? leaf.enumerators[static_cast<std::size_t>(value)] : number(value);
}

std::vector<double> times_of(const Capture& capture) {
  std::vector<double> times_s;
  const auto zero_ns = capture.rows.empty() ? 0 : capture.rows[capture.trigger.value_or(0)].time_ns;
  for (const auto& row : capture.rows) times_s.push_back(static_cast<double>(row.time_ns - zero_ns) / 1e9);
  return times_s;
}

std::vector<double> values_of(const Capture& capture, std::size_t column, double factor) {
  std::vector<double> values;
  for (const auto& row : capture.rows) values.push_back(row.values[column] * factor);
  return values;
}

std::string panel_title(const std::string& name, const LeafType& leaf, const Display& display,
                        const std::vector<double>& values, const std::optional<std::size_t>& trigger) {
  std::string title = name + (display.unit.empty() ? "" : " [" + display.unit + "]");
  if (const auto extent = extent_of(values))
    title += "  min " + value_text(leaf, extent->low) + "  max " + value_text(leaf, extent->high);
  else
    title += "  no value";
  if (trigger) title += "  at trigger " + value_text(leaf, values[*trigger]);
  return title;
}

}  // namespace

std::string picture_of(const Capture& capture, const FieldTable& table, const std::vector<Field>& columns,
                       const std::string& trigger, const TerminalSize& size) {
  const auto times_s = times_of(capture);
  std::string text;
  if (capture.trigger)
    text = "trigger at tick " + std::to_string(capture.rows[*capture.trigger].tick) + ": " + trigger;
  else
    text = "no trigger (automatic): " + trigger;
  text += "  (" + std::to_string(capture.rows.size()) + " ticks" + (capture.complete ? "" : ", incomplete") +
          ")\n";
  if (times_s.empty() || columns.empty()) return text;

  const auto rows = static_cast<std::size_t>(std::max(size.rows, 0));
  const auto room = rows > kFrame ? (rows - kFrame) / columns.size() : 0;
  CurveBox box{.columns = std::max(size.columns - kLabelColumns - 1, 10),
               .rows = static_cast<int>(std::clamp<std::size_t>(room, 3, kLargestPanel + 1)) - 1,
               .from_s = times_s.front(),
               .to_s = std::max(times_s.back(), times_s.front() + 1e-9)};
  if (capture.trigger) box.mark_s = 0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto& leaf = table.leaf_of(columns[i]);
    const auto display = display_of(leaf);
    const auto values = values_of(capture, i, display.factor);
    text += panel_title(table.name_of(columns[i]), leaf, display, values, capture.trigger) + '\n';
    text += draw_curve(times_s, values, box);
  }
  return text + draw_time_axis(box);
}

recording::Table table_of(const Capture& capture, const FieldTable& table,
                          const std::vector<Field>& columns) {
  recording::Table result;
  result.columns.push_back({"time_s", times_of(capture)});
  result.columns.push_back({"tick", {}});
  for (const auto& row : capture.rows) result.columns.back().values.push_back(static_cast<double>(row.tick));
  for (std::size_t i = 0; i < columns.size(); ++i)
    result.columns.push_back({table.name_of(columns[i]), values_of(capture, i, 1)});
  return result;
}

}  // namespace crane::cli
