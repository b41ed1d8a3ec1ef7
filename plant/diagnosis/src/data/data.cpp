#include "crane/diagnosis/data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "crane/plant/pendulum.hpp"
#include "data/broken.hpp"
#include "data/columns.hpp"
#include "data/grid.hpp"
#include "data/sensor.hpp"
#include "data/swapped.hpp"

namespace crane::diagnosis {
namespace {

/// Shorter pieces are not used: less than half a swing of 1 m of cable.
constexpr double kShortest_s = 1.0;
/// After a longer gap the state is unknown: in periods of the load; for drives alone in s.
constexpr double kLostPeriods = 1.0, kLost_s = 2.0;
/// Slowest sampling that follows a swing, with 1 % error of the clock, s.
constexpr double kSlowestRow_s = 0.1 * 1.01;
/// A shorter time step indicates times in another unit, s.
constexpr double kFastestRow_s = 1e-5;
/// Largest number of grid rows per measured row: data with more consist mainly of gaps.
constexpr double kMostGridRowsPerRow = 50;
/// Ratio of a step to the usual step: a larger step contains missing rows.
constexpr double kMissingRowRatio = 1.5;

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

double lost_after_s(const configuration::Rig& rig) {
  const double cable_m = rig.start.position[plant::kHoist];
  if (!(rig.plant.load_mass_kg > 0 && cable_m > 0)) return kLost_s;
  return kLostPeriods * plant::swing_period_s(rig.plant.gravity_mps2, cable_m);
}

/// Splits checked columns into runs where the state is lost.
class RunSplitter {
 public:
  RunSplitter(const Columns& columns, const configuration::Rig& rig, Findings& findings)
      : columns_(columns), rig_(rig), findings_(findings), grid_(grid_of(*columns.time_s)) {}

  std::vector<Run> runs() {
    if (grid_.row_s > kSlowestRow_s) {
      findings_.problem("time_s", "sampled every " + number(grid_.row_s) + " s",
                        "must be at most 0.1 s (10 samples per second)");
      return {};
    }
    if (!(grid_.row_s > kFastestRow_s)) {
      findings_.problem("time_s", "sampled every " + number(grid_.row_s) + " s",
                        "must be at least 1e-5 s (100 000 samples per second): check the unit of time_s");
      return {};
    }
    cut();
    if (runs_.empty() && findings_.problems.empty())
      findings_.problem("time_s", "no range without a gap lasts " + number(kShortest_s) + " s",
                        "record longer");
    add_notes();
    return std::move(runs_);
  }

 private:
  /// True if an axis moves farther than its drive permits: a counter was reset or wrapped.
  [[nodiscard]] bool jumps(std::size_t row) {
    bool any = false;
    for (std::size_t i = 0; i < kOutputs; ++i) {
      const auto* values = columns_.outputs[i].values;
      if (values == nullptr || !std::isfinite((*values)[row])) continue;
      const std::size_t before = last_seen_[i];
      last_seen_[i] = row;
      if (before == kNone) continue;
      const double time_s = (*columns_.time_s)[row] - (*columns_.time_s)[before];
      const double most =
          largest_credible_change(rig_, static_cast<Output>(i), time_s) + kBeyondSensor * sensors_[i].error();
      any = any || std::abs((*values)[row] - (*values)[before]) > most;
    }
    return any;
  }

  [[nodiscard]] bool measured_or_commanded(std::size_t row) {
    bool measured = false, complete = true;
    for (const Source& source : columns_.outputs)
      if (source.values != nullptr) {
        const bool present = std::isfinite((*source.values)[row]);
        measured = measured || present;
        complete = complete && present;
      }
    bool commanded = false;
    for (const Source& source : columns_.commands)
      if (source.values != nullptr) commanded = commanded || std::isfinite((*source.values)[row]);
    if (!complete) count_row(incomplete_, row);
    return measured || commanded;
  }

  void cut() {
    for (std::size_t i = 0; i < kOutputs; ++i)
      if (columns_.outputs[i].values != nullptr) sensors_[i] = sensor_of(*columns_.outputs[i].values);
    const auto& t = *columns_.time_s;
    const double lost_s = lost_after_s(rig_);
    std::vector<std::size_t> piece;
    const auto finish = [&] {
      add(piece);
      piece.clear();
    };
    for (std::size_t k = 0; k < t.size(); ++k) {
      if (!measured_or_commanded(k)) continue;
      if (!piece.empty()) {
        const double step_s = t[k] - t[piece.back()];
        const bool other_stretch =
            columns_.stretch != nullptr && (*columns_.stretch)[k] != (*columns_.stretch)[piece.back()];
        if (other_stretch) {
          finish();
        } else if (step_s > lost_s) {
          count_row(gaps_, k);
          finish();
        } else if (step_s > kMissingRowRatio * grid_.row_s) {
          dropped_rows_ += static_cast<std::size_t>(std::lround(step_s / grid_.row_s)) - 1;
        }
      }
      if (piece.empty()) last_seen_.fill(kNone);
      if (jumps(k)) {
        count_row(resets_, k);
        finish();
      }
      piece.push_back(k);
    }
    finish();
  }

  void add(const std::vector<std::size_t>& rows) {
    if (rows.empty()) return;
    const auto& t = *columns_.time_s;
    if (t[rows.back()] - t[rows.front()] < kShortest_s) {
      ++short_pieces_;
      return;
    }
    if (t[rows.back()] - t[rows.front()] >
        kMostGridRowsPerRow * grid_.period_s * static_cast<double>(rows.size())) {
      findings_.problem("time_s", "rows come every " + number(grid_.row_s) + " s, and most are missing",
                        "at least one row in fifty must exist");
      return;
    }
    Run run = on_grid(columns_, rows, grid_, rig_.start.position[plant::kHoist], left_out_);
    const std::size_t part = runs_.size() + 1;
    run.name = part == 1 ? findings_.file : findings_.file + ", part " + std::to_string(part);
    for (std::size_t i = 0; i < kOutputs; ++i) run.resolution[i] = sensors_[i].resolution;
    run.load_mass_kg = columns_.load_mass_kg;
    runs_.push_back(std::move(run));
  }

  struct Named {
    std::size_t count = 0, first = 0;
  };
  static void count_row(Named& all, std::size_t row) {
    if (all.count++ == 0) all.first = row;
  }
  /// "row 12 at 0.11 s"
  [[nodiscard]] std::string place(const Named& all) const {
    return "row " + std::to_string(all.first + 1) + " at " + number((*columns_.time_s)[all.first]) + " s" +
           (all.count > 1 ? ", ..." : "");
  }

  void add_notes() {
    const auto note = [&](std::size_t count, const std::string& what) {
      if (count > 0) findings_.note(std::to_string(count) + " " + what);
    };
    note(incomplete_.count, "rows lack a value (" + place(incomplete_) + "): it is not compared there");
    note(dropped_rows_, "rows are missing; nothing is put in their place");
    note(gaps_.count, "gaps after which the state is not known (" + place(gaps_) + "); the run is cut there");
    note(resets_.count,
         "jumps of a position faster than the axis (" + place(resets_) + "); the run is cut there");
    if (left_out_.own_times) findings_.note("irregular sampling: compared at the rows' own times");
    note(left_out_.crowded, "rows closer together than " + number(grid_.period_s) + " s left out");
    note(short_pieces_, "pieces shorter than " + number(kShortest_s) + " s left out");
    if (grid_.rows_in_period > 1)
      findings_.note(
          "one row in " + std::to_string(grid_.rows_in_period) +
          " is compared: nothing of a crane moves faster than 100 samples a second show; commands act at "
          "their own times");
  }

  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  const Columns& columns_;
  const configuration::Rig& rig_;
  Findings& findings_;
  Grid grid_;
  std::array<Sensor, kOutputs> sensors_{};
  std::array<std::size_t, kOutputs> last_seen_{kNone, kNone, kNone, kNone};
  Named incomplete_, gaps_, resets_;
  std::size_t dropped_rows_ = 0, short_pieces_ = 0;
  LeftOut left_out_;
  std::vector<Run> runs_;
};

}  // namespace

DataError::DataError(std::vector<std::string> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

bool Run::regular(Output output) const {
  return offset_s.empty() && std::all_of(measured[output].begin(), measured[output].end(),
                                         [](double x) { return std::isfinite(x); });
}

Loaded load_run(const recording::Table& table, const configuration::Rig& rig, const std::string& name) {
  Findings findings{.file = name, .problems = {}, .notes = {}};
  recording::Table kept = table;
  const bool timed = times_increase(kept, findings);
  if (timed) omit_spikes_and_frozen(kept, rig, findings);
  hold_axes_at_rest(kept, rig, findings);
  const Columns columns = checked_columns(kept, rig, findings);
  if (!findings.problems.empty()) throw DataError(findings.problems);
  std::vector<Run> runs = RunSplitter(columns, rig, findings).runs();
  find_swapped(runs, rig, findings);
  if (!findings.problems.empty()) throw DataError(findings.problems);
  return {std::move(runs), std::move(findings.notes)};
}

}  // namespace crane::diagnosis
