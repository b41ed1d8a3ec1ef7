#include <algorithm>

#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

constexpr double kShortestCable_m = 1e-3;
constexpr double kHighestLimit = 1000;  // m or rad: no crane of this project is longer

/// Travel of a reference that reaches the soft limit at the planner's speed and is then stopped by the brake:
/// v (t_detect + t_react + t_brake) + v^2 / (2 a), with one tick each to detect and to react.
double stopping_travel(const Drive& drive, double period_s) {
  const double speed = drive.reference_speed;
  return speed * (2 * period_s + drive.brake_close_time_s) + speed * speed / (2 * drive.brake_deceleration);
}

void check_drive(TomlTable& table, const AxisText& axis, const Drive& drive, double period_s) {
  const std::string margin_key = with_unit("soft_margin", axis.unit);
  if (drive.low_limit >= drive.high_limit) {
    table.problem(with_unit("low_limit", axis.unit), "must be below " + with_unit("high_limit", axis.unit));
  } else if (2 * drive.soft_margin >= drive.high_limit - drive.low_limit) {
    table.problem(margin_key, "must leave room between the limits");
  }
  const double travel = stopping_travel(drive, period_s);
  if (drive.reference_speed > drive.max_speed) {
    table.problem(with_unit("reference_speed", axis.speed),
                  "must not exceed " + with_unit("max_speed", axis.speed));
  } else if (drive.soft_margin < travel) {
    table.problem(margin_key, "must be at least " + std::to_string(travel) +
                                  ": v (t_detect + t_react + t_brake) + v^2/2a at the reference speed");
  }
}

void read_limits_of(TomlTable& table, const AxisText& axis, Drive& drive) {
  // A cable has a length: its limits are positive.
  const Range limit = axis.name == "hoist" ? Range::closed(kShortestCable_m, kHighestLimit)
                                           : Range::closed(-kHighestLimit, kHighestLimit);
  drive.low_limit = table.number(with_unit("low_limit", axis.unit), limit);
  drive.high_limit = table.number(with_unit("high_limit", axis.unit), limit);
  drive.soft_margin = table.number(with_unit("soft_margin", axis.unit), Range::not_negative());
  drive.max_speed = table.number(with_unit("max_speed", axis.speed), Range::positive());
}

Drive read_drive(TomlTable& table, const AxisText& axis, double period_s) {
  Drive drive;
  drive.present = true;
  drive.dac_channel = table.integer("dac_channel", 0, kLastChannel);
  drive.sign = read_sign(table);
  drive.volt_limit_v = table.number("volt_limit_v", Range::above(0, 10), drive.volt_limit_v);
  drive.volt_rate_limit_vps =
      table.number("volt_rate_limit_vps", Range::positive(), drive.volt_rate_limit_vps);
  read_limits_of(table, axis, drive);
  drive.brake_deceleration =
      table.number(with_unit("brake_deceleration", axis.acceleration), Range::positive());
  const Range brake_time = Range::closed(0, 1);
  drive.brake_close_time_s = table.number("brake_close_time_s", brake_time, drive.brake_close_time_s);
  drive.brake_open_time_s = table.number("brake_open_time_s", brake_time, drive.brake_open_time_s);
  const Range planned = Range::closed(1e-6, 1e6);  // what a trajectory can be planned with
  if (axis.unit == "rad") {
    drive.brake_slip = 0.05;
    drive.standstill_speed = 0.01;
  }
  drive.reference_speed = table.number(with_unit("reference_speed", axis.speed), planned);
  drive.reference_acceleration =
      table.number(with_unit("reference_acceleration", axis.acceleration), planned);
  // A ramp rises to full acceleration within a tenth of a second unless the file says otherwise.
  drive.reference_jerk =
      table.number(with_unit("reference_jerk", axis.jerk), planned, 10 * drive.reference_acceleration);
  check_drive(table, axis, drive, period_s);
  return drive;
}

/// Which drives belong to a kind of rig: a gantry does not slew, a pendulum hangs from a fixed point.
void check_drives_of_kind(TomlTable& table, const Rig& rig) {
  const auto has = [&rig](plant::Axis axis) { return rig.drives[axis].present; };
  const auto count =
      std::count_if(rig.drives.begin(), rig.drives.end(), [](const Drive& d) { return d.present; });
  const bool needs_trolley = rig.kind == RigKind::tower || rig.kind == RigKind::gantry;
  if (needs_trolley && !has(plant::kTrolley))
    table.problem("trolley", "missing: every crane has a trolley drive");
  if (rig.kind == RigKind::tower && !has(plant::kSlew)) table.problem("slew", "missing: a tower crane slews");
  if (rig.kind == RigKind::gantry && has(plant::kSlew)) table.problem("slew", "a gantry has no slew drive");
  if (rig.kind == RigKind::drive_axis && count != 1) table.problem("must be one drive for a drive_axis");
  if (rig.kind == RigKind::pendulum && count != 0) table.problem("a pendulum has no drives");
}

}  // namespace

int read_sign(TomlTable& table) {
  const int sign = table.integer("sign", -1, 1, 1);
  if (sign == 0) table.problem("sign", "must be 1 or -1");
  return sign;
}

void check_unique(TomlTable& table, std::string_view key, int channel, std::vector<int>& taken) {
  if (channel < 0) return;  // reported already
  if (std::find(taken.begin(), taken.end(), channel) != taken.end()) {
    table.problem(key, "must be used once: another section has this channel");
  }
  taken.push_back(channel);
}

void read_drives(TomlTable& root, Rig& rig) {
  TomlTable drives = rig.kind == RigKind::pendulum ? root.table("drive") : root.required_table("drive");
  std::vector<int> taken;
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    TomlTable table = drives.table(kAxisTexts[i].name);
    if (!table.present()) continue;
    rig.drives[i] = read_drive(table, kAxisTexts[i], rig.period_s);
    check_unique(table, "dac_channel", rig.drives[i].dac_channel, taken);
  }
  if (drives.present()) check_drives_of_kind(drives, rig);
}

}  // namespace crane::configuration
