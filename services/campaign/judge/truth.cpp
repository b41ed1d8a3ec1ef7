#include "campaign/judge/truth.hpp"

#include <algorithm>
#include <cmath>

namespace crane::campaign {
namespace {

constexpr double kBridgeSpeed = 1.1, kBridgeSwing = 1.5, kLargestSwing_rad = 1.55;  // docs/hardware.md

double count_of(const configuration::Rig& rig, std::size_t counter) {
  const double per_unit = rig.encoders[counter].counts_per_unit;
  return per_unit > 0 ? 1 / per_unit : 0;
}

/// Speed that the encoders show: distance in the last tick plus one count.
double shown_speed(const configuration::Rig& rig, std::span<const Row> rows, std::size_t k,
                   std::size_t axis) {
  if (k == 0) return 0;
  const double distance = std::abs(rows[k].truth.position[axis] - rows[k - 1].truth.position[axis]);
  return (distance + count_of(rig, axis)) / rig.period_s;
}

bool beyond(const configuration::Rig& rig, std::span<const Row> rows, std::size_t k, std::size_t axis,
            double reaction_s) {
  const auto& drive = rig.drives[axis];
  const double x = rows[k].truth.position[axis], count = count_of(rig, axis);
  const double distance = stopping_distance(drive, shown_speed(rig, rows, k, axis), reaction_s) + count;
  const double from = k > 0 ? rows[k - 1].truth.position[axis] : x;
  return (x >= from && x + distance > drive.high_limit) || (x <= from && x - distance < drive.low_limit);
}

bool swings_beyond(const configuration::Rig& rig, const Row& row, double limit_rad) {
  return std::abs(row.truth.swing_radial_rad) + count_of(rig, 3) > limit_rad ||
         std::abs(row.truth.swing_tangential_rad) + count_of(rig, 4) > limit_rad;
}

bool is_true_at(const Reason& reason, const configuration::Rig& rig, std::span<const Row> rows,
                std::size_t k) {
  const double swing_rad = rig.limits.swing_limit_rad;
  const bool latched = reason.cause == crane_CAUSE_BRIDGE_LATCHED;
  if (reason.cause == crane_CAUSE_SWING_LIMIT) return swings_beyond(rig, rows[k], swing_rad);
  if (latched && reason.latch == crane_LATCH_SWING)
    return swings_beyond(rig, rows[k], std::min(kBridgeSwing * swing_rad, kLargestSwing_rad));
  for (std::size_t i = 0; i < kAxes; ++i) {
    const auto& drive = rig.drives[i];
    if (!drive.present) continue;
    const double v = shown_speed(rig, rows, k, i);
    if (reason.cause == crane_CAUSE_OVERSPEED && v > drive.max_speed) return true;
    if (reason.cause == crane_CAUSE_POSITION_LIMIT && beyond(rig, rows, k, i, -1)) return true;
    if (reason.cause == crane_CAUSE_STOPPING_ENVELOPE &&
        beyond(rig, rows, k, i, supervisor_reaction_s(rig, i)))
      return true;
    if (latched && reason.latch == crane_LATCH_SPEED && v > kBridgeSpeed * drive.max_speed) return true;
    if (latched && reason.latch == crane_LATCH_POSITION && beyond(rig, rows, k, i, drive.brake_close_time_s))
      return true;
  }
  return false;
}

}  // namespace

double stopping_distance(const configuration::Drive& drive, double speed, double reaction_s) {
  if (reaction_s < 0) return 0;
  return speed * reaction_s + speed * speed / (2 * drive.brake_deceleration);
}

double supervisor_reaction_s(const configuration::Rig& rig, std::size_t axis) {
  constexpr double kRamp_s = 0.02;
  return rig.period_s + kRamp_s + rig.drives[axis].brake_close_time_s;
}

bool is_true(const Reason& reason, const configuration::Rig& rig, std::span<const Row> rows, std::size_t k) {
  return is_true_at(reason, rig, rows, k) || (k > 0 && is_true_at(reason, rig, rows, k - 1));
}

}  // namespace crane::campaign
