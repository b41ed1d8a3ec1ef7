#include "data/grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "data/median.hpp"

namespace crane::diagnosis {
namespace {

/// 100 samples per second resolve the motion of a crane.
constexpr double kFinest_s = 0.01;
/// A second, shorter sample time: least share of the steps, largest ratio to the median.
constexpr double kSecondRateShare = 0.1, kSecondRateRatio = 0.75;
/// Shortest grid period of irregular rows: in s, and as a share of the median step.
constexpr double kLeastPeriod_s = 0.005, kLeastShare = 0.25;
/// Share of the period below which the offset of a row from the grid is neglected (1 um at 1 m/s and 10 ms).
constexpr double kOnGridTolerance = 1e-4;
/// Share of a period: a step that is nearer to a multiple of the period determines the period.
constexpr double kWholePeriodTolerance = 0.25;
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// Median step, or a second, shorter sample time of the file.
double usual_step(const std::vector<double>& steps) {
  const double middle = median(steps);
  std::vector<double> sorted = steps;
  const auto at =
      sorted.begin() + static_cast<std::ptrdiff_t>(kSecondRateShare * static_cast<double>(sorted.size()));
  std::nth_element(sorted.begin(), at, sorted.end());
  if (*at >= kSecondRateRatio * middle) return middle;
  return std::min(middle, std::max({*at, kLeastPeriod_s, kLeastShare * middle}));
}

/// The period near a guess of which most steps are multiples; otherwise the guess. The jitter of the times of
/// such rows has mean zero, so that all short steps count; without the uneven steps the grid would drift.
double period_near(const std::vector<double>& steps, double guess_s) {
  double time = 0, count = 0, regular = 0;
  for (const double step : steps) {
    const double periods = std::round(step / guess_s);
    if (periods < 1 || periods > 2) continue;
    time += step, count += periods;
    if (std::abs(step / guess_s - periods) <= kWholePeriodTolerance) regular += periods;
  }
  return regular > 0.5 * static_cast<double>(steps.size()) ? time / count : guess_s;
}

/// Grid row of each row. If several rows belong to one grid row, the row with the most measured values gets
/// it; among equal ones, the nearest.
class GridAssignment {
 public:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  /// @param values number of measured values of each row
  GridAssignment(const std::vector<double>& at, const std::vector<std::size_t>& values, const Grid& grid)
      : of_row_(at.size(), kNone) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double place = at[i] / grid.period_s;
      auto node = static_cast<std::size_t>(std::max(0.0, std::round(place)));
      const bool taken = i > 0 && !row_at_.empty() && node < row_at_.size();
      if (taken && grid.rows_in_period == 1 && std::abs(static_cast<double>(row_at_.size()) - place) < 1) {
        node = row_at_.size();  // early: the next grid row has no measurement yet
      } else if (taken) {
        const std::size_t other = row_at_[node];
        const auto distance = [&](std::size_t row) {
          return std::abs(at[row] / grid.period_s - static_cast<double>(node));
        };
        if (other != kNone &&
            (values[other] != values[i] ? values[other] > values[i] : distance(other) <= distance(i)))
          continue;
        if (other != kNone) of_row_[other] = kNone;
      }
      if (node >= row_at_.size()) row_at_.resize(node + 1, kNone);
      row_at_[node] = i;
      of_row_[i] = node;
    }
    // The last row of fast data can be measured before the next grid row without being near it.
    if (grid.rows_in_period > 1 && last_offset(at, grid) * static_cast<double>(grid.rows_in_period) < -0.5) {
      of_row_[row_at_.back()] = kNone;
      row_at_.pop_back();
      while (row_at_.back() == kNone) row_at_.pop_back();
    }
  }
  /// Offset of the last assigned row, in periods.
  [[nodiscard]] double last_offset(const std::vector<double>& at, const Grid& grid) const {
    return at[row_at_.back()] / grid.period_s - static_cast<double>(row_at_.size() - 1);
  }
  [[nodiscard]] std::size_t count() const { return row_at_.size(); }
  [[nodiscard]] std::size_t of_row(std::size_t row) const { return of_row_[row]; }

 private:
  std::vector<std::size_t> of_row_, row_at_;
};

/// A missing command has the value of the last command; before the first command, the value of the first.
std::vector<double> held_command(const std::vector<double>& values, const std::vector<std::size_t>& rows) {
  double last = 0;
  for (const std::size_t row : rows)
    if (std::isfinite(values[row])) {
      last = values[row];
      break;
    }
  std::vector<double> result;
  for (const std::size_t row : rows) result.push_back(last = std::isfinite(values[row]) ? values[row] : last);
  return result;
}

/// Rows lost between two rows of a file.
struct LostRows {
  std::size_t after = 0, count = 0;  ///< after: the row before them
};

/// Lost rows have a step of usual length beside them. A stretch with another sample time has none.
std::vector<LostRows> lost_rows(const std::vector<double>& at, double row_s) {
  constexpr double kLost = 1.5;  // usual distances
  const auto usual = [&](std::size_t k) { return k + 1 < at.size() && at[k + 1] - at[k] < kLost * row_s; };
  std::vector<LostRows> lost;
  for (std::size_t k = 0; k + 1 < at.size(); ++k)
    if (!usual(k) && (usual(k + 1) || (k > 0 && usual(k - 1))))
      lost.push_back({k, static_cast<std::size_t>(std::lround((at[k + 1] - at[k]) / row_s)) - 1});
  return lost;
}

/// The commands, interpolated linearly in lost rows.
std::vector<TimedCommand> with_interpolated_commands(const std::vector<TimedCommand>& commands,
                                                     const std::vector<LostRows>& lost) {
  std::vector<TimedCommand> all;
  auto next = lost.begin();
  for (std::size_t k = 0; k < commands.size(); ++k) {
    all.push_back(commands[k]);
    if (next == lost.end() || next->after != k) continue;
    const TimedCommand &from = commands[k], &to = commands[k + 1];
    for (std::size_t i = 1; i <= next->count; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(next->count + 1);
      TimedCommand between{from.time_s + share * (to.time_s - from.time_s), {}};
      for (std::size_t axis = 0; axis < between.drive_v.size(); ++axis)
        between.drive_v[axis] = (1 - share) * from.drive_v[axis] + share * to.drive_v[axis];
      all.push_back(between);
    }
    ++next;
  }
  return all;
}

/// True if the command changes more across lost rows than in the rows beside them: a step of the command at
/// an unknown time may be lost.
bool may_lack_step(const std::vector<TimedCommand>& commands, const LostRows& lost, plant::Axis axis) {
  constexpr double kLostStepRatio = 2;  // change across the lost rows / larger change per row beside them
  const auto change = [&](std::size_t k) {
    return k + 1 < commands.size() ? std::abs(commands[k + 1].drive_v[axis] - commands[k].drive_v[axis]) : 0;
  };
  const std::size_t k = lost.after;
  const double around = std::max(k > 0 ? change(k - 1) : 0, change(k + 1));
  return change(k) > kLostStepRatio * around * static_cast<double>(lost.count + 1);
}

/// Marks the grid rows that may have lost a step of the command, and the next row, because the step makes two
/// values unknown: distance and speed.
void mark_lost_steps(const std::vector<LostRows>& lost, Run& run) {
  for (const plant::Axis axis : {plant::kTrolley, plant::kSlew})
    for (const LostRows& one : lost) {
      if (!run.commanded[axis] || !may_lack_step(run.commands, one, axis)) continue;
      run.edge_lost[axis].resize(run.offset_s.size());
      const auto row_of = [&](std::size_t k) {
        return static_cast<std::size_t>(std::lround(run.commands[k].time_s / run.period_s));
      };
      const std::size_t last = std::min(row_of(one.after + 1), run.edge_lost[axis].size() - 1);
      for (std::size_t row = row_of(one.after) + 1; row <= last; ++row) run.edge_lost[axis][row] = true;
    }
}

/// Measured values, interpolated linearly; without measurements, the value of the rig file.
std::vector<double> cable_on_grid(const Run& run, const std::vector<double>& measured_m, double rigs_own_m) {
  std::vector<double> time_s, length_m;
  for (std::size_t k = 0; k < measured_m.size(); ++k)
    if (std::isfinite(measured_m[k])) time_s.push_back(run.instant_s(k)), length_m.push_back(measured_m[k]);
  if (time_s.empty()) return std::vector<double>(run.rows(), rigs_own_m);
  std::vector<double> result(run.rows());
  for (std::size_t k = 0, next = 0; k < result.size(); ++k) {
    const double at = static_cast<double>(k) * run.period_s;
    while (next < time_s.size() && time_s[next] < at) ++next;
    if (next == 0 || next == time_s.size()) {
      result[k] = next == 0 ? length_m.front() : length_m.back();
      continue;
    }
    const double share = (at - time_s[next - 1]) / (time_s[next] - time_s[next - 1]);
    result[k] = (1 - share) * length_m[next - 1] + share * length_m[next];
  }
  return result;
}

}  // namespace

Grid grid_of(const std::vector<double>& time_s) {
  std::vector<double> steps(time_s.size() - 1);
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k] = time_s[k + 1] - time_s[k];
  Grid grid;
  grid.row_s = usual_step(steps);
  const bool uniform = std::all_of(steps.begin(), steps.end(), [&](double step) {
    return std::abs(step - grid.row_s) <= kOnGridTolerance * grid.row_s;
  });
  if (!uniform) grid.row_s = period_near(steps, grid.row_s);
  constexpr double kShortestRow_s = 1e-6;  // avoids a division by 0; RunSplitter refuses rows below 1e-5 s
  if (!(grid.row_s > kShortestRow_s)) return {grid.row_s, grid.row_s, 1};
  grid.rows_in_period = std::max<std::size_t>(1, static_cast<std::size_t>(kFinest_s / grid.row_s + 1e-3));
  grid.period_s = static_cast<double>(grid.rows_in_period) * grid.row_s;
  return grid;
}

Run on_grid(const Columns& columns, const std::vector<std::size_t>& rows, const Grid& grid, double cable_m,
            LeftOut& left_out) {
  const std::vector<double>& t = *columns.time_s;
  std::vector<double> at;
  for (const std::size_t row : rows) at.push_back(t[row] - t[rows.front()]);
  std::vector<std::size_t> values(rows.size(), 0);
  for (const Source& source : columns.outputs)
    for (std::size_t r = 0; source.values != nullptr && r < rows.size(); ++r)
      values[r] += std::isfinite((*source.values)[rows[r]]) ? 1 : 0;
  const GridAssignment assignment(at, values, grid);
  Run run;
  run.period_s = grid.period_s;
  run.start_s = t[rows.front()];
  // The time of the last row must not lie after the grid.
  const std::size_t count =
      assignment.count() + (assignment.last_offset(at, grid) > kOnGridTolerance ? 1 : 0);
  std::vector<double> cable(count, kNotMeasured);
  run.offset_s.assign(count, 0.0);
  for (std::size_t i = 0; i < kOutputs; ++i)
    if (columns.outputs[i].values != nullptr) run.measured[i].assign(count, kNotMeasured);
  bool own_times = false;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::size_t node = assignment.of_row(r);
    if (node == GridAssignment::kNone) {
      left_out.crowded += grid.rows_in_period == 1 ? 1 : 0;
      continue;
    }
    const double offset_s = at[r] - static_cast<double>(node) * grid.period_s;
    if (std::abs(offset_s) > kOnGridTolerance * grid.period_s)
      run.offset_s[node] = offset_s, own_times = true;
    for (std::size_t i = 0; i < kOutputs; ++i)
      if (columns.outputs[i].values != nullptr) run.measured[i][node] = (*columns.outputs[i].values)[rows[r]];
    if (columns.cable.values != nullptr) cable[node] = (*columns.cable.values)[rows[r]];
  }
  left_out.own_times = left_out.own_times || own_times;
  run.commands.resize(rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) run.commands[r].time_s = at[r];
  for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
    run.commanded[axis] = columns.commands[axis].values != nullptr;
    if (!run.commanded[axis]) continue;
    const std::vector<double> volts = held_command(*columns.commands[axis].values, rows);
    for (std::size_t r = 0; r < rows.size(); ++r) run.commands[r].drive_v[axis] = volts[r];
  }
  const std::vector<LostRows> lost = lost_rows(at, grid.row_s);
  mark_lost_steps(lost, run);
  run.commands = with_interpolated_commands(run.commands, lost);
  run.command_v = mean_commands(run.commands, run.period_s, count);
  if (!own_times) run.offset_s.clear();
  if (!own_times && grid.rows_in_period == 1 && count == run.commands.size()) {
    for (std::size_t r = 0; r < count; ++r) run.command_v[r] = run.commands[r].drive_v;
    run.commands.clear();
  }
  run.cable_m = cable_on_grid(run, cable, cable_m);
  return run;
}

std::vector<plant::PerAxis> mean_commands(const std::vector<TimedCommand>& commands, double step_s,
                                          std::size_t count) {
  std::vector<plant::PerAxis> means(count);
  std::size_t now = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double from = static_cast<double>(k) * step_s, to = from + step_s;
    const double close = 1e-9 * step_s;
    while (now + 1 < commands.size() && commands[now + 1].time_s <= from + close) ++now;
    plant::PerAxis sum{};
    double at = from;
    while (now + 1 < commands.size() && commands[now + 1].time_s < to - close) {
      const double until = commands[now + 1].time_s;
      for (std::size_t axis = 0; axis < sum.size(); ++axis)
        sum[axis] += (until - at) * commands[now].drive_v[axis];
      at = until, ++now;
    }
    means[k] = commands[now].drive_v;
    if (at == from) continue;
    for (std::size_t axis = 0; axis < sum.size(); ++axis)
      means[k][axis] = (sum[axis] + (to - at) * commands[now].drive_v[axis]) / step_s;
  }
  return means;
}

}  // namespace crane::diagnosis
