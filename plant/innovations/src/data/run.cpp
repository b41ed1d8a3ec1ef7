#include <algorithm>
#include <cmath>
#include <limits>

#include "crane/innovations/data.hpp"
#include "crane/innovations/rules.hpp"

namespace crane::innovations {
namespace {

/// Rows whose time is finite and later than every one before.
std::vector<std::size_t> increasing_rows(const std::vector<double>& time_s) {
  std::vector<std::size_t> rows;
  double last = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < time_s.size(); ++k)
    if (std::isfinite(time_s[k]) && time_s[k] > last) rows.push_back(k), last = time_s[k];
  return rows;
}

Series series_of(const recording::Table& table, const char* column, const std::vector<double>& time_s,
                 const std::vector<std::size_t>& rows, double least = -1e100) {
  Series series;
  const auto* values = table.find(column);
  if (values == nullptr) return series;
  for (const std::size_t k : rows)
    if (std::isfinite((*values)[k]) && (least < (*values)[k])) {
      series.time_s.push_back(time_s[k]);
      series.value.push_back((*values)[k]);
    }
  return series;
}

std::array<bool, kChannels> channels_of(const runtime::Rig& rig) {
  switch (rig.kind) {
    case runtime::RigKind::tower:
      return {true, true, true, true};
    case runtime::RigKind::gantry:
      return {true, false, true, false};
    case runtime::RigKind::drive_axis:
      return {rig.drives[0].present, rig.drives[1].present, false, false};
    case runtime::RigKind::pendulum:
      return {false, false, true, true};
  }
  return {};
}

}  // namespace

double Run::begin_s() const {
  double begin = std::numeric_limits<double>::infinity();
  for (const Series& s : measured)
    if (!s.empty()) begin = std::min(begin, s.time_s.front());
  return begin;
}

double Run::end_s() const {
  double end = -std::numeric_limits<double>::infinity();
  for (const Series& s : measured)
    if (!s.empty()) end = std::max(end, s.time_s.back());
  return end;
}

std::size_t Run::values() const {
  std::size_t count = 0;
  for (const Series& s : measured) count += s.size();
  return count;
}

double resolution_of(const std::vector<double>& values) {
  std::vector<double> sorted = values, steps;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] - sorted[i - 1] > 1e-10) steps.push_back(sorted[i] - sorted[i - 1]);
  if (steps.empty()) return 0;
  const auto place = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 50);
  std::nth_element(steps.begin(), place, steps.end());
  return *place;
}

LoadedRun load_run(const recording::Table& table, const runtime::Rig& rig, const std::string& name) {
  LoadedRun loaded;
  const auto* time_s = table.find("time_s");
  if (time_s == nullptr) throw DataProblem(name + ": time_s: there is no such column");
  const auto rows = increasing_rows(*time_s);
  if (rows.size() < static_cast<std::size_t>(rule::kLeastRows.value))
    throw DataProblem(name + ": " + std::to_string(rows.size()) + " rows with increasing time: too few");
  if (const std::size_t lost = time_s->size() - rows.size(); lost > 0)
    loaded.notes.push_back(name + ": " + std::to_string(lost) +
                           " rows whose time does not increase are left out");
  Run& run = loaded.run;
  run.name = name;
  const auto has = channels_of(rig);
  constexpr std::array kCommands{"trolley_voltage_v", "slew_voltage_v"};
  for (std::size_t i = 0; i < 2; ++i)
    if (has[i]) run.command[i] = series_of(table, kCommands[i], *time_s, rows);
  for (std::size_t c = 0; c < kChannels; ++c)
    if (has[c]) {
      run.measured[c] = series_of(table, kChannelNames[c], *time_s, rows);
      run.resolution[c] = resolution_of(run.measured[c].value);
    }
  run.cable = series_of(table, "cable_length_m", *time_s, rows, 0);
  if (run.values() == 0) throw DataProblem(name + ": none of the columns of this kind of rig is measured");
  return loaded;
}

Run cut(const Run& run, double from_s, double to_s) {
  constexpr double kLead_s = 1;  // a late command of before still acts
  Run part = run;
  const auto keep = [&](Series& s, double lead_s = 0) {
    Series kept;
    for (std::size_t k = 0; k < s.size(); ++k)
      if (s.time_s[k] >= from_s - lead_s && s.time_s[k] <= to_s) {
        kept.time_s.push_back(s.time_s[k]);
        kept.value.push_back(s.value[k]);
      }
    s = std::move(kept);
  };
  for (Series& s : part.command) keep(s, kLead_s);
  for (Series& s : part.measured) keep(s);
  keep(part.cable, kLead_s);
  return part;
}

}  // namespace crane::innovations
