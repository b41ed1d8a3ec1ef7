#include "data/columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "data/median.hpp"

namespace crane::diagnosis {
namespace {

/// A drive asked for less stays where friction holds it.
constexpr double kStandingCommand_v = 0.5;
/// Swing beyond a straight angle both ways is not radians.
constexpr double kLargestSwing_rad = 3.3;

double spread(std::span<const double> values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  return high - low;
}

class Checks {
 public:
  Checks(const recording::Table& table, const configuration::Rig& rig, Findings& findings)
      : table_(table), rig_(rig), findings_(findings) {}

  Columns run() {
    columns_.time_s = table_.find("time_s");
    if (columns_.time_s == nullptr) findings_.problem("time_s", "missing", "the first column must be time_s");
    find_columns();
    if (columns_.time_s != nullptr) check_time();
    check_values();
    return std::move(columns_);
  }

 private:
  void find_columns() {
    const std::array<bool, kOutputs> expected{
        rig_.drives[plant::kTrolley].present, rig_.drives[plant::kSlew].present,
        rig_.measures(plant::kSwingRadial), rig_.measures(plant::kSwingTangential)};
    bool any = false;
    for (std::size_t i = 0; i < kOutputs; ++i) {
      columns_.outputs[i] = {kOutputNames[i], table_.find(kOutputNames[i])};
      if (!expected[i]) columns_.outputs[i].values = nullptr;
      any = any || columns_.outputs[i].values != nullptr;
    }
    if (!any)
      findings_.problem("columns", "none of the rig's positions or swing angles is there",
                        "see docs/data.md");
    for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
      const char* column = axis == plant::kTrolley ? "trolley_voltage_v" : "slew_voltage_v";
      columns_.commands[axis] = {column, table_.find(column)};
      if (columns_.outputs[axis].values != nullptr && columns_.commands[axis].values == nullptr)
        findings_.problem(column, "missing",
                          std::string{kOutputNames[axis]} + " needs the command that moved it");
    }
    if (rig_.drives[plant::kTrolley].present && columns_.outputs[kRadialSwing].values != nullptr &&
        columns_.outputs[kTrolleyPosition].values == nullptr)
      findings_.problem(kOutputNames[kTrolleyPosition], "missing", "swing needs the motion that excites it");
    columns_.cable = {"cable_length_m", table_.find("cable_length_m")};
  }

  void check_time() {
    const auto& t = *columns_.time_s;
    if (t.size() < 3) return findings_.problem("time_s", "fewer than three rows", "record longer");
    for (std::size_t k = 0; k < t.size(); ++k) {
      if (!std::isfinite(t[k]))
        return findings_.problem("time_s", "row " + std::to_string(k + 1) + " is not a number",
                                 "every row needs its time");
      if (k > 0 && t[k] <= t[k - 1])
        return findings_.problem(
            "time_s", "row " + std::to_string(k + 1) + ": " + number(t[k]) + " after " + number(t[k - 1]),
            "time must increase");
    }
    std::vector<double> steps(t.size() - 1);
    for (std::size_t k = 0; k + 1 < t.size(); ++k) steps[k] = t[k + 1] - t[k];
    columns_.period_s = median(steps);
    if (columns_.period_s > 0.05)
      findings_.problem("time_s", "sampled every " + number(columns_.period_s) + " s",
                        "at least 20 samples a second");
  }

  void check_values() {
    for (std::size_t i = 0; i < kOutputs; ++i) {
      if (columns_.outputs[i].values == nullptr) continue;
      const double range = spread(*columns_.outputs[i].values);
      if (!(range > 0))
        judge_constant(static_cast<Output>(i));
      else if (i >= kRadialSwing && largest(*columns_.outputs[i].values) > kLargestSwing_rad)
        findings_.problem(columns_.outputs[i].name, "reaches " + number(largest(*columns_.outputs[i].values)),
                          "a swing angle in radians stays below " + number(kLargestSwing_rad) + "; degrees?");
    }
    check_slew_unit();
    check_travel();
    for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
      if (columns_.commands[axis].values == nullptr || columns_.outputs[axis].values == nullptr) continue;
      if (const double most = largest(*columns_.commands[axis].values);
          most > 3 * rig_.drives[axis].volt_limit_v)
        findings_.problem(columns_.commands[axis].name, "reaches " + number(most) + " V",
                          "the drive takes " + number(rig_.drives[axis].volt_limit_v) + " V");
    }
  }

  /// An axis that is not asked to move, and the swing it would excite, may stand still.
  void judge_constant(Output output) {
    const Output drive = output == kTrolleyPosition || output == kRadialSwing ? kTrolleyPosition : kSlewAngle;
    const auto* command = columns_.commands[drive].values;
    const bool asked = command == nullptr || largest(*command) > kStandingCommand_v;
    const bool measured = std::isfinite(spread(*columns_.outputs[output].values));
    if (asked || !measured)
      findings_.problem(columns_.outputs[output].name, "constant or empty",
                        "a sensor that never changes says nothing");
    else
      findings_.note(columns_.outputs[output].name + " stands still");
  }

  void check_slew_unit() {
    const auto* slew = columns_.outputs[kSlewAngle].values;
    if (slew == nullptr) return;
    const configuration::Drive& drive = rig_.drives[plant::kSlew];
    const double allowed = std::max(std::abs(drive.low_limit), std::abs(drive.high_limit));
    if (largest(*slew) > 4 * std::max(allowed, std::numbers::pi))
      findings_.problem(columns_.outputs[kSlewAngle].name, "reaches " + number(largest(*slew)),
                        "the rig slews to " + number(allowed) + " rad; degrees?");
  }

  void check_travel() {
    const auto* trolley = columns_.outputs[kTrolleyPosition].values;
    if (trolley == nullptr) return;
    const configuration::Drive& drive = rig_.drives[plant::kTrolley];
    const double travel = drive.high_limit - drive.low_limit;
    if (spread(*trolley) > 5 * travel)
      findings_.problem(columns_.outputs[kTrolleyPosition].name, "moves over " + number(spread(*trolley)),
                        "the rig's travel is " + number(travel) + " m; millimetres?");
  }

  static double largest(std::span<const double> values) {
    double most = 0;
    for (const double value : values)
      if (std::isfinite(value)) most = std::max(most, std::abs(value));
    return most;
  }

  const recording::Table& table_;
  const configuration::Rig& rig_;
  Findings& findings_;
  Columns columns_;
};

}  // namespace

Columns checked_columns(const recording::Table& table, const configuration::Rig& rig, Findings& findings) {
  return Checks(table, rig, findings).run();
}

}  // namespace crane::diagnosis
