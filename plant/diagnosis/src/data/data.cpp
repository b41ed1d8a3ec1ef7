#include "crane/diagnosis/data.hpp"

#include <algorithm>
#include <cmath>

#include "data/columns.hpp"
#include "data/thinning.hpp"

namespace crane::diagnosis {
namespace {

/// Shorter pieces say nothing about a crane: less than half a swing of a metre of cable.
constexpr double kShortest_s = 1.0;
/// A time step further from the median is a gap.
constexpr double kGap = 1.5;
/// Steps within this share of the median count as uniform.
constexpr double kJitter = 0.02;

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

/// Cuts checked columns into runs.
class Cutter {
 public:
  Cutter(const Columns& columns, const configuration::Rig& rig, Findings& findings)
      : columns_(columns), rig_(rig), findings_(findings) {}

  std::vector<Run> runs() {
    cut();
    if (runs_.empty())
      findings_.problem("time_s", "no piece without a gap lasts " + number(kShortest_s) + " s",
                        "record longer");
    return std::move(runs_);
  }

 private:
  [[nodiscard]] bool complete(std::size_t row) const {
    for (const Source& source : columns_.outputs)
      if (source.values != nullptr && !std::isfinite((*source.values)[row])) return false;
    for (const Source& source : columns_.commands)
      if (source.values != nullptr && !std::isfinite((*source.values)[row])) return false;
    return columns_.cable.values == nullptr || std::isfinite((*columns_.cable.values)[row]);
  }

  /// A count that falls back to zero or wraps moves an axis further in one sample than it can.
  [[nodiscard]] bool jumps(std::size_t row) const {
    for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
      const auto* values = columns_.outputs[axis].values;
      if (values == nullptr) continue;
      const double most = 5 * std::max(rig_.drives[axis].max_speed, 0.1) *
                          ((*columns_.time_s)[row] - (*columns_.time_s)[row - 1]);
      if (std::abs((*values)[row] - (*values)[row - 1]) > most) return true;
    }
    return false;
  }

  void cut() {
    const auto& t = *columns_.time_s;
    std::size_t missing = 0, gaps = 0, resets = 0;
    std::vector<std::size_t> piece;
    const auto finish = [&] {
      add(piece);
      piece.clear();
    };
    for (std::size_t k = 0; k < t.size(); ++k) {
      if (!complete(k)) {
        ++missing;
        continue;
      }
      if (!piece.empty() && t[k] - t[piece.back()] > kGap * columns_.period_s) ++gaps, finish();
      if (!piece.empty() && piece.back() + 1 == k && jumps(k)) ++resets, finish();
      piece.push_back(k);
    }
    finish();
    if (missing > 0) findings_.note(std::to_string(missing) + " rows with missing values left out");
    if (gaps > 0) findings_.note(std::to_string(gaps) + " gaps in time; the run is cut there");
    if (resets > 0)
      findings_.note(std::to_string(resets) +
                     " jumps of a position faster than the axis; the run is cut there");
    if (resampled_ > 0)
      findings_.note("irregular sampling interpolated to " + number(columns_.period_s) + " s");
    if (dropped_ > 0)
      findings_.note(std::to_string(dropped_) + " pieces shorter than " + number(kShortest_s) +
                     " s left out");
  }

  void add(const std::vector<std::size_t>& rows) {
    if (rows.empty()) return;
    const auto& t = *columns_.time_s;
    if (t[rows.back()] - t[rows.front()] < kShortest_s) {
      ++dropped_;
      return;
    }
    Run run;
    const std::size_t part = runs_.size() + 1;
    run.name = part == 1 ? findings_.file : findings_.file + ", part " + std::to_string(part);
    run.period_s = columns_.period_s;
    run.start_s = t[rows.front()];
    bool uniform = true;
    for (std::size_t i = 0; i + 1 < rows.size(); ++i)
      uniform =
          uniform && std::abs(t[rows[i + 1]] - t[rows[i]] - columns_.period_s) <= kJitter * columns_.period_s;
    if (!uniform) ++resampled_;
    const auto count =
        uniform ? rows.size()
                : static_cast<std::size_t>((t[rows.back()] - t[rows.front()]) / columns_.period_s) + 1;
    const auto take = [&](const Source& source, bool hold) {
      return sampled(*source.values, rows, count, uniform, hold);
    };
    run.command_v.resize(count);
    for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
      if (columns_.commands[axis].values == nullptr) continue;
      const auto values = take(columns_.commands[axis], true);
      for (std::size_t k = 0; k < count; ++k) run.command_v[k][axis] = values[k];
    }
    for (std::size_t i = 0; i < kOutputs; ++i)
      if (columns_.outputs[i].values != nullptr) run.measured[i] = take(columns_.outputs[i], false);
    run.cable_m = columns_.cable.values != nullptr
                      ? take(columns_.cable, false)
                      : std::vector<double>(count, rig_.start.position[plant::kHoist]);
    runs_.push_back(std::move(run));
  }

  /// The rows themselves, or their values at uniform times: a command holds, a measurement is interpolated.
  [[nodiscard]] std::vector<double> sampled(const std::vector<double>& values,
                                            const std::vector<std::size_t>& rows, std::size_t count,
                                            bool uniform, bool hold) const {
    std::vector<double> result(count);
    std::size_t left = 0;
    for (std::size_t k = 0; k < count; ++k) {
      if (uniform) {
        result[k] = values[rows[k]];
        continue;
      }
      const double at = (*columns_.time_s)[rows.front()] + static_cast<double>(k) * columns_.period_s;
      while (left + 2 < rows.size() && (*columns_.time_s)[rows[left + 1]] <= at) ++left;
      const double t0 = (*columns_.time_s)[rows[left]], t1 = (*columns_.time_s)[rows[left + 1]];
      const double share = hold ? (at >= t1 ? 1.0 : 0.0) : std::clamp((at - t0) / (t1 - t0), 0.0, 1.0);
      result[k] = (1 - share) * values[rows[left]] + share * values[rows[left + 1]];
    }
    return result;
  }

  const Columns& columns_;
  const configuration::Rig& rig_;
  Findings& findings_;
  std::size_t resampled_ = 0, dropped_ = 0;
  std::vector<Run> runs_;
};

}  // namespace

DataError::DataError(std::vector<std::string> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

Loaded load_run(const recording::Table& table, const configuration::Rig& rig, const std::string& name) {
  Findings findings{.file = name, .problems = {}, .notes = {}};
  const Columns columns = checked_columns(table, rig, findings);
  if (!findings.problems.empty()) throw DataError(findings.problems);
  std::vector<Run> runs = Cutter(columns, rig, findings).runs();
  if (!findings.problems.empty()) throw DataError(findings.problems);
  return thinned({std::move(runs), std::move(findings.notes)});
}

}  // namespace crane::diagnosis
