#include "crane/supervisor/limits.hpp"

#include <algorithm>
#include <cmath>

#include "crane/control/drive_limit_fields.hpp"
#include "crane/plant/coordinates.hpp"

namespace crane::supervisor {
namespace {

class Problems {
 public:
  /// @pre `ok` is false for NaN
  void require(bool ok, const std::string& name, double value, const std::string& rule) {
    if (!ok) found_.push_back(fields::complaint(name, value, rule));
  }
  void in_range(const std::string& name, double value, const fields::Range& range) {
    require(range.contains(value), name, value, range.rule());
  }
  template <class Section, std::size_t N>
  void check(const Section& section, const std::array<fields::Field<Section>, N>& table,
             const std::string& prefix) {
    fields::check(section, table, prefix, found_);
  }
  void positive(const std::string& name, double value) {
    require(value > 0 && std::isfinite(value), name, value, "must be > 0");
  }
  void at_least(const std::string& name, double value, double low) { in_range(name, value, {.low = low}); }
  [[nodiscard]] bool empty() const { return found_.empty(); }
  [[nodiscard]] std::vector<std::string> take() { return std::move(found_); }

 private:
  std::vector<std::string> found_;
};

void check_homing(const std::string& prefix, const AxisLimits& axis, Problems& problems) {
  const auto& homing = axis.homing;
  problems.require(homing.position >= axis.low_limit && homing.position <= axis.high_limit,
                   prefix + "position", homing.position, "must lie between the hard limits");
  problems.check(homing, control::kHomingFields, prefix);
  problems.require(homing.speed >= homing.approach_speed && homing.speed <= axis.max_speed, prefix + "speed",
                   homing.speed, "must be at least approach_speed and at most max_speed");
  problems.require(homing.volt_limit_v <= axis.volt_limit_v, prefix + "volt_limit_v", homing.volt_limit_v,
                   "must be at most volt_limit_v of the drive");
}

void check_axis(const std::string& prefix, const AxisLimits& axis, Problems& problems) {
  problems.check(axis, control::kDriveLimitFields, prefix);
  problems.require(axis.high_limit > axis.low_limit, prefix + "high_limit", axis.high_limit,
                   "must be above low_limit");
  problems.require(2 * axis.soft_margin < axis.high_limit - axis.low_limit, prefix + "soft_margin",
                   axis.soft_margin, "must leave room between the hard limits");
  problems.positive(prefix + "standstill_speed", axis.standstill_speed);
  problems.positive(prefix + "brake_slip", axis.brake_slip);
  if (axis.homes()) check_homing(prefix + "homing.", axis, problems);
}

void check_common(const Limits& limits, Problems& problems) {
  problems.in_range("period_s", limits.period_s, plant::kPeriods);
  problems.check<control::OperatingLimits>(limits, control::kOperatingLimitFields, "");
  problems.at_least("swing_runaway_ratio", limits.swing_runaway_ratio, 1);
  problems.at_least("state_stale_after_ticks", limits.state_stale_after_ticks, 1);
  problems.at_least("demand_stale_after_ticks", limits.demand_stale_after_ticks, 1);
  problems.at_least("demand_invalid_in_row", limits.demand_invalid_in_row, 1);
  problems.at_least("overruns_in_row", limits.overruns_in_row, 0);
  problems.at_least("clear_time_s", limits.clear_time_s, 0);
  problems.at_least("fresh_time_s", limits.fresh_time_s, 0);
  problems.at_least("longest_wait_for_motion_s", limits.longest_wait_for_motion_s, 0);
  problems.positive("load_still_rad", limits.load_still_rad);
  problems.at_least("load_watch_s", limits.load_watch_s, limits.clear_time_s);
  problems.positive("standstill_time_s", limits.standstill_time_s);
  problems.require(limits.c1_ramp_time_s >= 0 && limits.c1_ramp_time_s <= 0.02, "c1_ramp_time_s",
                   limits.c1_ramp_time_s, "must be in [0, 0.02]");
  problems.positive("stop_timeout_s", limits.stop_timeout_s);
  problems.positive("arm_match_time_s", limits.arm_match_time_s);
  problems.positive("arm_volt_limit_v", limits.arm_volt_limit_v);
  problems.positive("brake_test_time_s", limits.brake_test_time_s);
  problems.positive("brake_report_time_s", limits.brake_report_time_s);
  problems.positive("relay_timeout_s", limits.relay_timeout_s);
  problems.positive("relay_report_time_s", limits.relay_report_time_s);
  problems.at_least("homing_overspeed_ratio", limits.homing_overspeed_ratio, 1);
  problems.require(std::ranges::any_of(limits.axis, &AxisLimits::present), "present axes", 0,
                   "at least one axis must be present");
  problems.require(limits.zones.size() <= control::kMostZones, "zones",
                   static_cast<double>(limits.zones.size()),
                   "must be at most " + std::to_string(control::kMostZones));
}

// Rules that relate several values. @pre each value is inside its range
void check_margins(const Limits& limits, Problems& problems) {
  for (std::size_t i = 0; i < kAxes; ++i) {
    const AxisLimits& axis = limits.axis[i];
    if (!axis.present) continue;
    const std::string prefix = std::string{plant::kCoordinates[i].name} + ".";
    const double distance = stopping_distance(limits, i, axis.max_speed);
    problems.require(axis.soft_margin >= distance, prefix + "soft_margin", axis.soft_margin,
                     "must be >= " + std::to_string(distance) +
                         ", the stopping distance from max_speed: v (t_detect + t_react + t_brake) + v^2/2a");
    problems.require(axis.brake_open_time_s < limits.brake_test_time_s, prefix + "brake_open_time_s",
                     axis.brake_open_time_s, "must be below brake_test_time_s");
  }
  const double loss_s = demand_loss_to_braked_s(limits);
  problems.require(loss_s <= kDemandLossToBrakedMax_s + 1e-9, "demand_loss_to_braked_s", loss_s,
                   "must be <= 0.1: lower demand_stale_after_s, period_s or brake_close_time_s");
}

}  // namespace

int ramp_ticks(const Limits& limits) noexcept {
  constexpr double kRounding = 1e-9;
  return std::max(1, static_cast<int>(std::ceil(limits.c1_ramp_time_s / limits.period_s - kRounding)));
}

double stopping_time_s(const Limits& limits, std::size_t axis) noexcept {
  return (1 + ramp_ticks(limits)) * limits.period_s + limits.axis[axis].brake_close_time_s;
}

double stopping_distance(const Limits& limits, std::size_t axis, double speed) noexcept {
  const double v = std::abs(speed);
  return v * stopping_time_s(limits, axis) + v * v / (2 * limits.axis[axis].brake_deceleration);
}

double demand_loss_to_braked_s(const Limits& limits) noexcept {
  double brake_s = 0;
  for (const AxisLimits& axis : limits.axis) {
    if (axis.present) brake_s = std::max(brake_s, axis.brake_close_time_s);
  }
  return (limits.demand_stale_after_ticks + ramp_ticks(limits)) * limits.period_s + brake_s;
}

bool target_allowed(const AxisLimits& axis, double target) noexcept {
  return target >= axis.low_limit + axis.soft_margin && target <= axis.high_limit - axis.soft_margin;
}

std::vector<std::string> problems(const Limits& limits) {
  Problems found;
  check_common(limits, found);
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (limits.axis[i].present)
      check_axis(std::string{plant::kCoordinates[i].name} + ".", limits.axis[i], found);
  }
  if (found.empty()) check_margins(limits, found);
  return found.take();
}

}  // namespace crane::supervisor
