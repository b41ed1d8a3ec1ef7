#include "crane/diagnosis/data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

#include "data/thinning.hpp"

namespace crane::diagnosis {
namespace {

/// Shorter pieces say nothing about a crane: less than half a swing of a metre of cable.
constexpr double kShortest_s = 1.0;
/// A time step further from the median is a gap.
constexpr double kGap = 1.5;
/// Steps within this share of the median count as uniform.
constexpr double kJitter = 0.02;
/// A drive asked for less stays where friction holds it.
constexpr double kStandingCommand_v = 0.5;
/// Swing beyond a straight angle both ways is not radians.
constexpr double kLargestSwing_rad = 3.3;

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

std::string number(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double spread(std::span<const double> values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  return high - low;
}

/// One column of the file with the place it has in a Run.
struct Source {
  std::string name;
  const std::vector<double>* values = nullptr;
};

class Loader {
 public:
  Loader(const recording::Table& table, const runtime::Rig& rig, std::string name)
      : table_(table), rig_(rig), name_(std::move(name)) {}

  Loaded load() {
    time_ = table_.find("time_s");
    if (time_ == nullptr) problem("time_s", "missing", "the first column must be time_s");
    find_columns();
    if (time_ != nullptr) check_time();
    check_values();
    if (!problems_.empty()) throw DataError(problems_);
    cut();
    if (loaded_.runs.empty()) {
      problem("time_s", "no piece without a gap lasts " + number(kShortest_s) + " s", "record longer");
      throw DataError(problems_);
    }
    return std::move(loaded_);
  }

 private:
  void problem(const std::string& column, const std::string& what, const std::string& rule) {
    problems_.push_back(name_ + ": " + column + ": " + what + ": " + rule);
  }
  void note(const std::string& text) { loaded_.notes.push_back(name_ + ": " + text); }

  void find_columns() {
    const std::array<bool, kOutputs> expected{
        rig_.drives[plant::kTrolley].present, rig_.drives[plant::kSlew].present,
        rig_.encoders[3].counts_per_unit > 0, rig_.encoders[4].counts_per_unit > 0};
    bool any = false;
    for (std::size_t i = 0; i < kOutputs; ++i) {
      outputs_[i] = {kOutputNames[i], table_.find(kOutputNames[i])};
      if (!expected[i]) outputs_[i].values = nullptr;
      any = any || outputs_[i].values != nullptr;
    }
    if (!any) problem("columns", "none of the rig's positions or swing angles is there", "see docs/data.md");
    for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
      const char* column = axis == plant::kTrolley ? "trolley_voltage_v" : "slew_voltage_v";
      commands_[axis] = {column, table_.find(column)};
      if (outputs_[axis].values != nullptr && commands_[axis].values == nullptr)
        problem(column, "missing", std::string{kOutputNames[axis]} + " needs the command that moved it");
    }
    if (rig_.drives[plant::kTrolley].present && outputs_[kRadialSwing].values != nullptr &&
        outputs_[kTrolleyPosition].values == nullptr)
      problem(kOutputNames[kTrolleyPosition], "missing", "swing needs the motion that excites it");
    cable_ = {"cable_length_m", table_.find("cable_length_m")};
  }

  void check_time() {
    const auto& t = *time_;
    if (t.size() < 3) return problem("time_s", "fewer than three rows", "record longer");
    for (std::size_t k = 0; k < t.size(); ++k) {
      if (!std::isfinite(t[k]))
        return problem("time_s", "row " + std::to_string(k + 1) + " is not a number",
                       "every row needs its time");
      if (k > 0 && t[k] <= t[k - 1])
        return problem("time_s",
                       "row " + std::to_string(k + 1) + ": " + number(t[k]) + " after " + number(t[k - 1]),
                       "time must increase");
    }
    std::vector<double> steps(t.size() - 1);
    for (std::size_t k = 0; k + 1 < t.size(); ++k) steps[k] = t[k + 1] - t[k];
    period_s_ = median(steps);
    if (period_s_ > 0.05)
      problem("time_s", "sampled every " + number(period_s_) + " s", "at least 20 samples a second");
  }

  void check_values() {
    for (std::size_t i = 0; i < kOutputs; ++i) {
      if (outputs_[i].values == nullptr) continue;
      const double range = spread(*outputs_[i].values);
      if (!(range > 0))
        judge_constant(static_cast<Output>(i));
      else if (i >= kRadialSwing && largest(*outputs_[i].values) > kLargestSwing_rad)
        problem(outputs_[i].name, "reaches " + number(largest(*outputs_[i].values)),
                "a swing angle in radians stays below " + number(kLargestSwing_rad) + "; degrees?");
    }
    check_slew_unit();
    check_travel();
    for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
      if (commands_[axis].values == nullptr || outputs_[axis].values == nullptr) continue;
      if (const double most = largest(*commands_[axis].values); most > 3 * rig_.drives[axis].volt_limit_v)
        problem(commands_[axis].name, "reaches " + number(most) + " V",
                "the drive takes " + number(rig_.drives[axis].volt_limit_v) + " V");
    }
  }

  /// An axis that is not asked to move, and the swing it would excite, may stand still.
  void judge_constant(Output output) {
    const Output drive = output == kTrolleyPosition || output == kRadialSwing ? kTrolleyPosition : kSlewAngle;
    const auto* command = commands_[drive].values;
    const bool asked = command == nullptr || largest(*command) > kStandingCommand_v;
    const bool measured = std::isfinite(spread(*outputs_[output].values));
    if (asked || !measured)
      problem(outputs_[output].name, "constant or empty", "a sensor that never changes says nothing");
    else
      note(outputs_[output].name + " stands still");
  }

  void check_slew_unit() {
    const auto* slew = outputs_[kSlewAngle].values;
    if (slew == nullptr) return;
    const runtime::Drive& drive = rig_.drives[plant::kSlew];
    const double allowed = std::max(std::abs(drive.low_limit), std::abs(drive.high_limit));
    if (largest(*slew) > 4 * std::max(allowed, std::numbers::pi))
      problem(outputs_[kSlewAngle].name, "reaches " + number(largest(*slew)),
              "the rig slews to " + number(allowed) + " rad; degrees?");
  }

  void check_travel() {
    const auto* trolley = outputs_[kTrolleyPosition].values;
    if (trolley == nullptr) return;
    const runtime::Drive& drive = rig_.drives[plant::kTrolley];
    const double travel = drive.high_limit - drive.low_limit;
    if (spread(*trolley) > 5 * travel)
      problem(outputs_[kTrolleyPosition].name, "moves over " + number(spread(*trolley)),
              "the rig's travel is " + number(travel) + " m; millimetres?");
  }

  static double largest(std::span<const double> values) {
    double most = 0;
    for (const double value : values)
      if (std::isfinite(value)) most = std::max(most, std::abs(value));
    return most;
  }

  [[nodiscard]] bool complete(std::size_t row) const {
    for (const Source& source : outputs_)
      if (source.values != nullptr && !std::isfinite((*source.values)[row])) return false;
    for (const Source& source : commands_)
      if (source.values != nullptr && !std::isfinite((*source.values)[row])) return false;
    return cable_.values == nullptr || std::isfinite((*cable_.values)[row]);
  }

  /// A count that falls back to zero or wraps moves an axis further in one sample than it can.
  [[nodiscard]] bool jumps(std::size_t row) const {
    for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
      const auto* values = outputs_[axis].values;
      if (values == nullptr) continue;
      const double most =
          5 * std::max(rig_.drives[axis].max_speed, 0.1) * ((*time_)[row] - (*time_)[row - 1]);
      if (std::abs((*values)[row] - (*values)[row - 1]) > most) return true;
    }
    return false;
  }

  void cut() {
    const auto& t = *time_;
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
      if (!piece.empty() && t[k] - t[piece.back()] > kGap * period_s_) ++gaps, finish();
      if (!piece.empty() && piece.back() + 1 == k && jumps(k)) ++resets, finish();
      piece.push_back(k);
    }
    finish();
    if (missing > 0) note(std::to_string(missing) + " rows with missing values left out");
    if (gaps > 0) note(std::to_string(gaps) + " gaps in time; the run is cut there");
    if (resets > 0)
      note(std::to_string(resets) + " jumps of a position faster than the axis; the run is cut there");
    if (resampled_ > 0) note("irregular sampling interpolated to " + number(period_s_) + " s");
    if (dropped_ > 0)
      note(std::to_string(dropped_) + " pieces shorter than " + number(kShortest_s) + " s left out");
  }

  void add(const std::vector<std::size_t>& rows) {
    if (rows.empty()) return;
    const auto& t = *time_;
    if (t[rows.back()] - t[rows.front()] < kShortest_s) {
      ++dropped_;
      return;
    }
    Run run;
    const std::size_t part = loaded_.runs.size() + 1;
    run.name = part == 1 ? name_ : name_ + ", part " + std::to_string(part);
    run.period_s = period_s_;
    run.start_s = t[rows.front()];
    bool uniform = true;
    for (std::size_t i = 0; i + 1 < rows.size(); ++i)
      uniform = uniform && std::abs(t[rows[i + 1]] - t[rows[i]] - period_s_) <= kJitter * period_s_;
    if (!uniform) ++resampled_;
    const auto count =
        uniform ? rows.size() : static_cast<std::size_t>((t[rows.back()] - t[rows.front()]) / period_s_) + 1;
    const auto take = [&](const Source& source, bool hold) {
      return sampled(*source.values, rows, count, uniform, hold);
    };
    run.command_v.resize(count);
    for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
      if (commands_[axis].values == nullptr) continue;
      const auto values = take(commands_[axis], true);
      for (std::size_t k = 0; k < count; ++k) run.command_v[k][axis] = values[k];
    }
    for (std::size_t i = 0; i < kOutputs; ++i)
      if (outputs_[i].values != nullptr) run.measured[i] = take(outputs_[i], false);
    run.cable_m = cable_.values != nullptr ? take(cable_, false)
                                           : std::vector<double>(count, rig_.start.position[plant::kHoist]);
    loaded_.runs.push_back(std::move(run));
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
      const double at = (*time_)[rows.front()] + static_cast<double>(k) * period_s_;
      while (left + 2 < rows.size() && (*time_)[rows[left + 1]] <= at) ++left;
      const double t0 = (*time_)[rows[left]], t1 = (*time_)[rows[left + 1]];
      const double share = hold ? (at >= t1 ? 1.0 : 0.0) : std::clamp((at - t0) / (t1 - t0), 0.0, 1.0);
      result[k] = (1 - share) * values[rows[left]] + share * values[rows[left + 1]];
    }
    return result;
  }

  const recording::Table& table_;
  const runtime::Rig& rig_;
  std::string name_;
  const std::vector<double>* time_ = nullptr;
  std::array<Source, kOutputs> outputs_;
  std::array<Source, 2> commands_;
  Source cable_;
  double period_s_ = 0;
  std::size_t resampled_ = 0, dropped_ = 0;
  std::vector<std::string> problems_;
  Loaded loaded_;
};

}  // namespace

DataError::DataError(std::vector<std::string> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

Loaded load_run(const recording::Table& table, const runtime::Rig& rig, const std::string& name) {
  return thinned(Loader(table, rig, name).load());
}

}  // namespace crane::diagnosis
