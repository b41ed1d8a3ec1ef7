#include "tuning/wiring.hpp"

#include <algorithm>
#include <cmath>

#include "crane/plant/coordinates.hpp"
#include "tuning/identify.hpp"

namespace crane::tuning {
namespace {

constexpr double kMoved_counts = 20;  // smallest motion in counts: more than quantisation
constexpr double kMoved = 0.002;      // smallest motion, m or rad
constexpr double kCertain = 0.7;      // lower bound of the friction / voltage at the first motion
constexpr double kIdle_v = 0.5;       // largest voltage of an axis that must not move
constexpr double kMean_s = 0.1;       // time before a motion over which the voltage is averaged

struct AxisData {
  std::vector<double> position, volts;
  double threshold = 0;  ///< smallest motion, m or rad
  double period_s = 0;
};

AxisData data_of(const recording::Table& table, const configuration::Rig& rig, std::size_t axis) {
  AxisData data;
  if (const auto* values = table.find(plant::kCoordinates[axis].column)) data.position = *values;
  if (const auto* values = table.find(plant::kCoordinates[axis].command_v)) data.volts = *values;
  data.period_s = rig.period_s;
  data.threshold = std::max(kMoved, kMoved_counts / rig.encoders[axis].counts_per_unit);
  return data;
}

/// First row that is beyond the previous extreme by more than the threshold in `direction` (1 or -1).
std::optional<std::size_t> first_motion(const AxisData& data, int direction) {
  if (data.position.empty()) return std::nullopt;
  double extreme = data.position[0];
  for (std::size_t k = 0; k < data.position.size(); ++k) {
    if (direction * (data.position[k] - extreme) > data.threshold) return k;
    extreme = direction > 0 ? std::min(extreme, data.position[k]) : std::max(extreme, data.position[k]);
  }
  return std::nullopt;
}

/// Mean voltage over the time kMean_s before a row.
double volts_before(const AxisData& data, std::size_t row) {
  const auto rows = static_cast<std::size_t>(std::lround(kMean_s / data.period_s));
  const std::size_t first = row > rows ? row - rows : 0;
  double sum = 0;
  for (std::size_t k = first; k <= row; ++k) sum += data.volts[k];
  return sum / static_cast<double>(row - first + 1);
}

std::string name(std::size_t axis) { return plant::kCoordinates[axis].name; }

double largest_volts(const AxisData& data) {
  double largest = 0;
  for (const double v : data.volts) largest = std::max(largest, std::abs(v));
  return largest;
}

/// Axis other than `axis` whose encoder moves while its own drive has almost no voltage.
std::optional<std::size_t> moved_instead(const recording::Table& table, const configuration::Rig& rig,
                                         std::size_t axis) {
  for (const std::size_t other : {plant::kTrolley, plant::kSlew}) {
    if (other == axis || !rig.drives[other].present) continue;
    const auto data = data_of(table, rig, other);
    for (const int direction : {1, -1})
      if (const auto row = first_motion(data, direction); row && std::abs(volts_before(data, *row)) < kIdle_v)
        return other;
  }
  return std::nullopt;
}

}  // namespace

ProbeFinding examine_probe(const Motion& motion, const configuration::Rig& rig, std::size_t axis,
                           bool largest) {
  ProbeFinding finding;
  const auto data = data_of(motion.table, rig, axis);
  const auto forward = first_motion(data, 1), backward = first_motion(data, -1);
  const auto first = forward && (!backward || *forward < *backward) ? forward : backward;
  if (first) {
    const double volts = volts_before(data, *first);
    if ((first == forward ? volts : -volts) < 0) {
      finding.problems.push_back("encoder." + name(axis) + ".sign, drive." + name(axis) + ".sign: the " +
                                 name(axis) +
                                 " moves against its voltage: one of the two signs is wrong, or the counter "
                                 "or the output of another "
                                 "axis is connected");
      return finding;
    }
  }
  if (const auto other = moved_instead(motion.table, rig, axis); other && !first) {
    finding.problems.push_back("encoder." + name(axis) + ".channel, encoder." + name(*other) +
                               ".channel: the voltage of the " + name(axis) + " moves the encoder of the " +
                               name(*other) + ": the encoders or the drives are exchanged");
    return finding;
  }
  finding.moved = forward && backward;
  // Voltage at the first motion; without a motion, the largest voltage.
  const auto holds_v = [&](const std::optional<std::size_t>& motion_row) {
    return motion_row ? std::abs(volts_before(data, *motion_row)) : largest_volts(data);
  };
  finding.friction_low_v = kCertain * std::min(holds_v(forward), holds_v(backward));
  if (finding.moved)
    finding.friction_v =
        (std::abs(volts_before(data, *forward)) + std::abs(volts_before(data, *backward))) / 2;
  if (!finding.moved && largest)
    finding.problems.push_back("drive." + name(axis) + ": the " + name(axis) + " does not move at " +
                               recording::shortest(std::round(10 * largest_volts(data)) / 10) +
                               " V: check amplifier, brake and encoder");
  return finding;
}

std::vector<std::string> examine_swing(const Motion& motion, const configuration::Rig& rig,
                                       std::size_t axis) {
  const std::size_t swing = axis == plant::kTrolley ? plant::kSwingRadial : plant::kSwingTangential;
  const std::size_t other = axis == plant::kTrolley ? plant::kSwingTangential : plant::kSwingRadial;
  const auto spread = [&](std::size_t coordinate) {
    const auto* values = motion.table.find(plant::kCoordinates[coordinate].column);
    if (values == nullptr || values->empty() || !rig.measures(coordinate)) return 0.0;
    const auto [low, high] = std::ranges::minmax(*values);
    return high - low;
  };
  const double resolution = 1 / rig.encoders[swing].counts_per_unit;
  constexpr double kVisible_counts = 6;
  const std::string channel = "encoder." + name(swing);
  if (spread(swing) < kVisible_counts * resolution)
    return {channel + (spread(other) > kVisible_counts * resolution
                           ? ".channel, encoder." + name(other) + ".channel: the motion of the " +
                                 name(axis) + " swings the other angle: the encoders are exchanged"
                           : ": the motion of the " + name(axis) +
                                 " does not swing the load: check the encoder and its cable")};
  Motion inverted = motion;
  for (auto& column : inverted.table.columns)
    if (column.name == plant::kCoordinates[swing].column)
      for (double& value : column.values) value = -value;
  const auto residual = [&](const Motion& as) {
    std::vector<diagnosis::PreparedRun> runs;
    runs.push_back(prepared(as.table, rig));
    return fit_load(runs, rig, {}).residual_rms;
  };
  if (residual(inverted) < 0.5 * residual(motion))
    return {channel + ".sign: the load swings against the motion of the " + name(axis) +
            ": the sign of the encoder is wrong"};
  return {};
}

}  // namespace crane::tuning
