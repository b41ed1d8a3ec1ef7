#include "data/broken.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "crane/plant/pendulum.hpp"
#include "data/sensor.hpp"

namespace crane::diagnosis {
namespace {

/// Longest spike in rows: a longer deviation is a shift of the sensor's zero.
constexpr std::size_t kLongestSpike = 5;
/// Share of spikes beyond which a column is refused.
constexpr double kLargestBrokenShare = 0.05;
/// Frozen: constant for longer than both, after steps of more than kMovingRatio sensor errors, until a step
/// that is larger than a motion from rest: the axis has moved meanwhile.
constexpr double kMovingRatio = 8, kFrozen_s = 0.25;
constexpr std::size_t kFrozenRows = 10, kExamples = 3;

struct BrokenRows {
  std::size_t first = 0, last = 0;  ///< inclusive
};

class Column {
 public:
  Column(std::vector<double>& values, const std::vector<double>& time_s, const configuration::Rig& rig,
         Output output)
      : values_(values), time_s_(time_s), rig_(rig), output_(output), error_(sensor_of(values).error()) {
    for (std::size_t k = 0; k < values.size(); ++k)
      if (std::isfinite(values[k])) measured_rows_.push_back(k);
  }

  /// Rows that deviate by more than the credible motion, if the motion continues after them.
  std::vector<BrokenRows> spikes() {
    std::vector<BrokenRows> found;
    for (std::size_t good = 0, i = 1; i < measured_rows_.size(); ++i) {
      const std::size_t latest = std::min(i + kLongestSpike, measured_rows_.size() - 1);
      std::size_t back = i;
      while (back <= latest && beyond(measured_rows_[good], measured_rows_[back], measured_rows_[back]))
        ++back;
      bool spike = back > i && back <= latest;
      for (std::size_t k = i; k < back && spike; ++k)
        spike = beyond(measured_rows_[good], measured_rows_[k], measured_rows_[back]);
      if (spike) {
        found.push_back({measured_rows_[i], measured_rows_[back - 1]});
        i = back;
      }
      good = i;
    }
    return found;
  }

  std::vector<BrokenRows> freezes() {
    std::vector<BrokenRows> found;
    for (std::size_t i = 3; i < measured_rows_.size();) {
      std::size_t end = i + 1;
      while (end < measured_rows_.size() && values_[measured_rows_[end]] == values_[measured_rows_[i]]) ++end;
      const bool lasts =
          end - i > kFrozenRows && time_s_[measured_rows_[end - 1]] - time_s_[measured_rows_[i]] > kFrozen_s;
      if (lasts && end < measured_rows_.size() && steps(i - 1, i) && steps(i - 2, i - 1) &&
          !from_rest(end - 1))
        found.push_back({measured_rows_[i + 1], measured_rows_[end - 1]});
      i = end;
    }
    return found;
  }

  void leave_out(const std::vector<BrokenRows>& broken) {
    for (const BrokenRows& rows : broken)
      for (std::size_t k = rows.first; k <= rows.last; ++k)
        values_[k] = std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] std::size_t measured_rows() const { return measured_rows_.size(); }

 private:
  /// True when the value at `b` differs from that at `a` by more than the credible motion until `until`.
  [[nodiscard]] bool beyond(std::size_t a, std::size_t b, std::size_t until) const {
    return !(std::abs(values_[b] - values_[a]) <=
             largest_credible_change(rig_, output_, time_s_[until] - time_s_[a]) + kBeyondSensor * error_);
  }
  [[nodiscard]] bool steps(std::size_t i, std::size_t j) const {
    return std::abs(values_[measured_rows_[j]] - values_[measured_rows_[i]]) > kMovingRatio * error_;
  }

  /// True when the motion from `k` to the next row is credible if the axis stands at `k`.
  [[nodiscard]] bool from_rest(std::size_t k) const {
    const double time_s = time_s_[measured_rows_[k + 1]] - time_s_[measured_rows_[k]];
    return std::abs(values_[measured_rows_[k + 1]] - values_[measured_rows_[k]]) <=
           largest_change_from_rest(rig_, output_, time_s) + kMovingRatio * error_;
  }

  std::vector<double>& values_;
  const std::vector<double>& time_s_;
  const configuration::Rig& rig_;
  Output output_;
  double error_;
  std::vector<std::size_t> measured_rows_;
};

/// "3 spikes (row 12 at 0.11 s: 1e+07; ...)"
void add_finding(const std::string& column, const char* what, const std::vector<BrokenRows>& broken,
                 const std::vector<double>& time_s, const std::vector<double>& values, std::size_t of,
                 Findings& findings) {
  if (broken.empty()) return;
  std::size_t rows = 0;
  std::string named;
  for (std::size_t i = 0; i < broken.size(); ++i) {
    rows += broken[i].last - broken[i].first + 1;
    if (i >= kExamples) continue;
    named += (named.empty() ? "row " : "; row ") + std::to_string(broken[i].first + 1);
    if (broken[i].last > broken[i].first) named += " to " + std::to_string(broken[i].last + 1);
    named += " at " + number(time_s[broken[i].first]) + " s: " + number(values[broken[i].first]);
  }
  if (broken.size() > kExamples) named += "; and " + std::to_string(broken.size() - kExamples) + " more";
  if (static_cast<double>(rows) > kLargestBrokenShare * static_cast<double>(of) &&
      std::string{what} == "spikes")
    findings.problem(
        column, std::to_string(rows) + " of " + std::to_string(of) + " values are spikes (" + named + ")",
        "at most 5 % of the values may be spikes: check the sensor");
  else
    findings.note(column + ": " + what + " left out (" + named + ")");
}

}  // namespace

double largest_credible_change(const configuration::Rig& rig, Output output, double time_s) {
  // kHand_mps: no hand moves a support faster.
  constexpr double kDriveSpeedRatio = 5, kSlowestDrive = 0.1, kSwingSpeedRatio = 3, kHand_mps = 5;
  const bool drive = output == kTrolleyPosition || output == kSlewAngle;
  if (drive && !rig.drives[output].present) return kHand_mps * time_s;
  if (drive) return kDriveSpeedRatio * std::max(rig.drives[output].max_speed, kSlowestDrive) * time_s;
  const double length_m = std::max(rig.start.position[plant::kHoist], 0.05);
  return kSwingSpeedRatio * 2 * plant::swing_radps(rig.plant.gravity_mps2, length_m) * time_s;
}

double largest_change_from_rest(const configuration::Rig& rig, Output output, double time_s) {
  if (output != kTrolleyPosition && output != kSlewAngle) return 0;
  constexpr double kForces = 3;  // of the command, of the back EMF and viscous friction, of dry friction
  const double gain = output == kSlewAngle ? rig.plant.slew_gain_radps2pv : rig.plant.trolley_gain_mps2pv;
  return 0.5 * kForces * gain * rig.drives[output].volt_limit_v * time_s * time_s;
}

void omit_spikes_and_frozen(recording::Table& table, const configuration::Rig& rig, Findings& findings) {
  const auto* time_s = table.find("time_s");
  if (time_s == nullptr) return;
  const std::vector<double> times = *time_s;
  for (const Output output : {kTrolleyPosition, kSlewAngle, kRadialSwing, kTangentialSwing}) {
    const auto found = std::find_if(table.columns.begin(), table.columns.end(),
                                    [&](const auto& column) { return column.name == kOutputNames[output]; });
    if (found == table.columns.end()) continue;
    const std::vector<double> before = found->values;
    Column column(found->values, times, rig, output);
    const std::vector<BrokenRows> spikes = column.spikes(), freezes = column.freezes();
    column.leave_out(spikes);
    column.leave_out(freezes);
    add_finding(found->name, "spikes", spikes, times, before, column.measured_rows(), findings);
    add_finding(found->name, "values that do not change while it moves", freezes, times, before,
                column.measured_rows(), findings);
  }
}

}  // namespace crane::diagnosis
