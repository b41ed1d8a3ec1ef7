#include "data/columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "crane/diagnosis/mapping.hpp"
#include "data/median.hpp"

namespace crane::diagnosis {
namespace {

constexpr std::array kCommands{"trolley_voltage_v", "slew_voltage_v"};
/// Counts over which the encoder of an axis at rest may flicker.
constexpr double kRestingCounts = 2, kRounding_counts = 0.5;
/// A smaller command may not overcome friction.
constexpr double kStandingCommand_v = 0.5;
/// A larger swing is not in radians: more than half a turn.
constexpr double kLargestSwing_rad = 3.3;

double range_of(std::span<const double> values) {
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
    check_values();
    return std::move(columns_);
  }

 private:
  void find_columns() {
    // The support of a pendulum may be moved by hand.
    const std::array<bool, kOutputs> expected{
        rig_.drives[plant::kTrolley].present || rig_.kind == configuration::RigKind::pendulum,
        rig_.drives[plant::kSlew].present, rig_.measures(plant::kSwingRadial),
        rig_.measures(plant::kSwingTangential)};
    bool any = false;
    for (std::size_t i = 0; i < kOutputs; ++i) {
      columns_.outputs[i] = {kOutputNames[i], table_.find(kOutputNames[i])};
      if (!expected[i]) leave_out(static_cast<Output>(i));
      any = any || columns_.outputs[i].values != nullptr;
    }
    if (!any)
      findings_.problem("columns",
                        "the file has neither a position of trolley or slew nor a swing angle of this rig "
                        "(the hoist is not diagnosed)",
                        "see docs/data.md");
    find_commands();
    if (rig_.drives[plant::kTrolley].present && columns_.outputs[kRadialSwing].values != nullptr &&
        columns_.outputs[kTrolleyPosition].values == nullptr)
      findings_.problem(kOutputNames[kTrolleyPosition], "missing",
                        "a radial swing needs the measured position of the trolley");
    columns_.cable = {"cable_length_m", table_.find("cable_length_m")};
    columns_.stretch = table_.find(kStretchColumn);
    if (const auto* mass = table_.find(kLoadMassColumn); mass != nullptr && !mass->empty())
      columns_.load_mass_kg = mass->front();
  }

  /// Does not use a column that the rig file does not describe. A motion of the support would excite the
  /// swing and is therefore refused.
  void leave_out(Output output) {
    Source& source = columns_.outputs[output];
    const auto* values = std::exchange(source.values, nullptr);
    if (values == nullptr || !(range_of(*values) > 0)) return;
    if (output == kRadialSwing || output == kTangentialSwing)
      findings_.note(source.name + " is not compared: the rig file has no such sensor");
    else
      findings_.problem(source.name, "moves", "the rig file has no such axis");
  }

  /// All measured drives that move must have a command, or none. Without commands, the motion of the drives
  /// is the measured motion of the support.
  void find_commands() {
    bool any = false, swings = false;
    for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
      columns_.commands[axis] = {kCommands[axis], table_.find(kCommands[axis])};
      any = any || columns_.commands[axis].values != nullptr;
    }
    for (const Output swing : {kRadialSwing, kTangentialSwing})
      swings = swings || columns_.outputs[swing].values != nullptr;
    bool alone = false;
    for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
      const auto* position = columns_.outputs[axis].values;
      if (position == nullptr || columns_.commands[axis].values != nullptr) continue;
      if (any && range_of(*position) == 0) continue;
      if (any)
        findings_.problem(
            columns_.commands[axis].name, "missing",
            "add this command, or omit the commands of both drives: then only the load is compared");
      else if (!swings)
        findings_.problem(columns_.commands[axis].name, "missing",
                          "add this command, or a swing angle that the motion excites");
      else
        alone = true;
    }
    if (alone)
      findings_.note(
          "no command: the measured motion of the drives moves the load, and the load alone is compared");
  }

  void check_values() {
    for (std::size_t i = 0; i < kOutputs; ++i) {
      if (columns_.outputs[i].values == nullptr) continue;
      const double range = range_of(*columns_.outputs[i].values);
      if (!(range > 0))
        judge_constant(static_cast<Output>(i));
      else if (i >= kRadialSwing && largest(*columns_.outputs[i].values) > kLargestSwing_rad)
        findings_.problem(columns_.outputs[i].name, "reaches " + number(largest(*columns_.outputs[i].values)),
                          "must not exceed " + number(kLargestSwing_rad) + " rad: check for degrees");
    }
    check_cable();
    check_slew_unit();
    check_travel();
    for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
      if (columns_.commands[axis].values == nullptr || columns_.outputs[axis].values == nullptr) continue;
      if (const double most = largest(*columns_.commands[axis].values);
          most > 3 * rig_.drives[axis].volt_limit_v)
        findings_.problem(columns_.commands[axis].name, "reaches " + number(most) + " V",
                          "must not exceed " + number(3 * rig_.drives[axis].volt_limit_v) +
                              " V, three times volt_limit_v of the rig file");
    }
  }

  /// An axis without a command to move, and the swing in its plane, may be at rest.
  void judge_constant(Output output) {
    const Output drive = output == kTrolleyPosition || output == kRadialSwing ? kTrolleyPosition : kSlewAngle;
    const auto* command = columns_.commands[drive].values;
    const bool support = output < kRadialSwing && command == nullptr;
    const bool commanded = !support && (command == nullptr || largest(*command) > kStandingCommand_v);
    const bool measured = std::isfinite(range_of(*columns_.outputs[output].values));
    if (commanded || !measured)
      findings_.problem(columns_.outputs[output].name, "constant or empty",
                        "check the sensor, or omit the column");
    else
      findings_.note(columns_.outputs[output].name + " stands still");
  }

  void check_cable() {
    constexpr double kLongest_m = 1000;
    if (columns_.cable.values == nullptr) return;
    for (std::size_t k = 0; k < columns_.cable.values->size(); ++k)
      if (const double length = (*columns_.cable.values)[k]; length <= 0 || length > kLongest_m)
        return findings_.problem(columns_.cable.name, "row " + std::to_string(k + 1) + ": " + number(length),
                                 "a length in metres, above 0");
  }

  void check_slew_unit() {
    const auto* slew = columns_.outputs[kSlewAngle].values;
    if (slew == nullptr) return;
    const configuration::Drive& drive = rig_.drives[plant::kSlew];
    const double allowed = std::max(std::abs(drive.low_limit), std::abs(drive.high_limit));
    if (largest(*slew) > 4 * std::max(allowed, std::numbers::pi))
      findings_.problem(columns_.outputs[kSlewAngle].name, "reaches " + number(largest(*slew)),
                        "the rig file permits " + number(allowed) + " rad: check for degrees");
  }

  void check_travel() {
    const auto* trolley = columns_.outputs[kTrolleyPosition].values;
    if (trolley == nullptr || !rig_.drives[plant::kTrolley].present) return;
    const configuration::Drive& drive = rig_.drives[plant::kTrolley];
    const double travel = drive.high_limit - drive.low_limit;
    if (range_of(*trolley) > 5 * travel)
      findings_.problem(columns_.outputs[kTrolleyPosition].name, "moves over " + number(range_of(*trolley)),
                        "the rig file permits a travel of " + number(travel) + " m: check for millimetres");
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

bool times_increase(recording::Table& table, Findings& findings) {
  const auto* time_s = table.find("time_s");
  if (time_s == nullptr) return false;
  const std::vector<double> t = *time_s;
  const auto wrong = [&](std::size_t k, const std::string& what, const char* rule) {
    findings.problem("time_s", "row " + std::to_string(k + 1) + what, rule);
    return false;
  };
  std::vector<bool> again(t.size(), false);
  std::size_t repeated = 0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    if (!std::isfinite(t[k])) return wrong(k, " is not a number", "every row needs its time");
    if (k > 0 && t[k] < t[k - 1])
      return wrong(k, ": " + number(t[k]) + " after " + number(t[k - 1]), "time must increase");
    if (k > 0 && t[k] == t[k - 1]) again[k] = true, ++repeated;
  }
  if (repeated > 0) {
    const auto first = static_cast<std::size_t>(std::find(again.begin(), again.end(), true) - again.begin());
    findings.note("time_s: " + std::to_string(repeated) +
                  " rows at the time of the one before left out (row " + std::to_string(first + 1) + " at " +
                  number(t[first]) + " s" + (repeated > 1 ? ", ...)" : ")"));
    for (auto& column : table.columns) {
      std::vector<double> kept;
      for (std::size_t k = 0; k < t.size(); ++k)
        if (!again[k]) kept.push_back(column.values[k]);
      column.values = std::move(kept);
    }
  }
  if (t.size() - repeated >= 3) return true;
  findings.problem("time_s", "fewer than three rows", "record longer");
  return false;
}

void hold_axes_at_rest(recording::Table& table, const configuration::Rig& rig, Findings& findings) {
  const bool commanded =
      std::ranges::any_of(kCommands, [&](const char* name) { return table.find(name) != nullptr; });
  for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
    const auto column = std::ranges::find(table.columns, std::string_view{kOutputNames[axis]},
                                          &recording::Table::Column::name);
    if (!commanded || table.find(kCommands[axis]) != nullptr || column == table.columns.end()) continue;
    const double range = range_of(column->values), counts_per_unit = rig.encoders[axis].counts_per_unit;
    if (!(counts_per_unit > 0 && range > 0 && range * counts_per_unit < kRestingCounts + kRounding_counts))
      continue;
    std::vector<double> finite;
    std::ranges::copy_if(column->values, std::back_inserter(finite),
                         [](double x) { return std::isfinite(x); });
    const double rest = median(std::move(finite));
    for (double& value : column->values)
      if (std::isfinite(value)) value = rest;
    findings.note(column->name + " stays within " + number(kRestingCounts) + " counts: at rest at " +
                  number(rest));
  }
}

Columns checked_columns(const recording::Table& table, const configuration::Rig& rig, Findings& findings) {
  return Checks(table, rig, findings).run();
}

}  // namespace crane::diagnosis
