#include <algorithm>
#include <cmath>

#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

/// Distance that an axis moves beyond the soft limit at the planner's speed before the brake has stopped it:
/// v (t_detect + t_react + t_brake) + v^2 / (2 a), with one tick each to detect and to react.
double stopping_travel(const Drive& drive, double period_s) {
  const double speed = drive.reference_speed;
  return speed * (2 * period_s + drive.brake_close_time_s) + speed * speed / (2 * drive.brake_deceleration);
}

void check_drive(TomlTable& table, const plant::Coordinate& axis, const Drive& drive, double period_s) {
  const auto limit = [&axis](std::string_view key) { return key_in(control::kDriveLimitFields, key, axis); };
  // A cable length is positive.
  if (&axis == &plant::kCoordinates[plant::kHoist])
    check_range(table, limit("low_limit"), drive.low_limit, plant::kCableLengths);
  if (drive.low_limit >= drive.high_limit) {
    table.problem(limit("low_limit"), "must be below " + limit("high_limit"));
  } else if (2 * drive.soft_margin >= drive.high_limit - drive.low_limit) {
    table.problem(limit("soft_margin"), "must be less than half the distance between the limits");
  }
  const double travel = stopping_travel(drive, period_s);
  if (drive.reference_speed > drive.max_speed) {
    table.problem(key_in(kDriveFields, "reference_speed", axis), "must not exceed " + limit("max_speed"));
  } else if (drive.soft_margin < travel) {
    table.problem(limit("soft_margin"), "must be at least " + std::to_string(travel) +
                                            ", the stopping distance from the reference speed "
                                            "(docs/safety.md, the gate and the stopping distance)");
  }
}

Drive read_drive(TomlTable& table, const plant::Coordinate& axis, const Rig& rig) {
  Drive drive;
  drive.present = true;
  if (std::string_view{axis.unit} == "rad") {
    drive.brake_slip = 0.05;
    drive.standstill_speed = 0.01;
  }
  read_section(table, kDriveFields, drive, &rig, axis.unit);
  read_section(table, control::kDriveLimitFields, drive, &rig, axis.unit);
  check_sign(table, drive.sign);
  check_drive(table, axis, drive, rig.period_s);
  check_plausible_drive(table, axis, drive);
  return drive;
}

/// Drives that each kind of rig must have or cannot have.
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

void check_sign(TomlTable& table, int sign) {
  if (sign == 0) table.problem("sign", "must be 1 or -1");
}

void check_range(TomlTable& table, std::string_view key, double value, const Range& range) {
  if (!std::isnan(value) && !range.contains(value)) table.problem(key, range.rule());
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
    TomlTable table = drives.table(plant::kCoordinates[i].name);
    if (!table.present()) continue;
    rig.drives[i] = read_drive(table, plant::kCoordinates[i], rig);
    check_unique(table, "dac_channel", rig.drives[i].dac_channel, taken);
  }
  if (drives.present()) check_drives_of_kind(drives, rig);
}

}  // namespace crane::configuration
