#include <algorithm>
#include <cmath>

#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

using control::Mark;
using control::Zero;

void check_zero(TomlTable& encoder, const Rig& rig, const Drive& drive) {
  if (drive.zero == Zero::absolute && rig.board != "simulated")
    encoder.problem("zero", "must be start or homing: the counters of this board are incremental");
}

/// Defaults of [homing.NAME]. @pre the mark has been read
void set_defaults(Drive& drive) {
  constexpr double kShareOfPlanned = 0.1, kBackOff = 0.02, kUsual_v = 5;
  auto& homing = drive.homing;
  homing.position = homing.mark == Mark::limit_high ? drive.high_limit : drive.low_limit;
  homing.speed = kShareOfPlanned * drive.reference_speed;
  homing.back_off = kBackOff;
  homing.volt_limit_v = std::min(kUsual_v, drive.volt_limit_v);
}

void check_position(TomlTable& table, const std::string& key, const Drive& drive) {
  const auto& homing = drive.homing;
  if (!(drive.low_limit < drive.high_limit)) return;  // reported already
  check_range(table, key, homing.position, Range::closed(drive.low_limit, drive.high_limit));
  const double end = homing.mark == Mark::limit_low ? drive.low_limit : drive.high_limit;
  if (homing.mark == Mark::input && !table.has(key)) table.problem(key, "missing");
  if (homing.mark != Mark::input && std::abs(homing.position - end) > drive.soft_margin)
    table.problem(key, "must be within the soft margin of its limit");
}

void read_homing_of(TomlTable& table, const plant::Coordinate& axis, const Rig& rig, std::size_t i,
                    Drive& drive) {
  const auto key = [&axis](std::string_view field) { return key_in(control::kHomingFields, field, axis); };
  auto& homing = drive.homing;
  read_section(table, kMarkFields, homing, &rig, axis.unit);
  if (homing.mark == Mark::input && rig.wiring.drives[i].mark_input < 0)
    table.problem("mark", "needs mark_input in [wiring." + std::string{axis.name} + "]");
  set_defaults(drive);
  read_section(table, control::kHomingFields, homing, &rig, axis.unit);
  check_position(table, key("position"), drive);
  const auto at_most = [&](std::string_view field, double value, double most) {
    if (value > most) table.problem(key(field), Range::above(0, most).rule());
  };
  at_most("speed", homing.speed, drive.reference_speed);
  at_most("approach_speed", homing.approach_speed, homing.speed);
  at_most("volt_limit_v", homing.volt_limit_v, drive.volt_limit_v);
}

}  // namespace

void read_homing(TomlTable& root, Rig& rig) {
  TomlTable encoders = root.table("encoder");
  bool any = false;
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    if (!rig.drives[i].present) continue;
    TomlTable encoder = encoders.table(plant::kCoordinates[i].name);
    read_section(encoder, kZeroFields, rig.drives[i], &rig);
    check_zero(encoder, rig, rig.drives[i]);
    any = any || rig.drives[i].homes();
  }
  TomlTable homing = any ? root.required_table("homing") : root.table("homing");
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    Drive& drive = rig.drives[i];
    if (!drive.present) continue;
    const plant::Coordinate& axis = plant::kCoordinates[i];
    TomlTable table = drive.homes() ? homing.required_table(axis.name) : homing.table(axis.name);
    if (!table.present()) continue;
    read_homing_of(table, axis, rig, i, drive);
    if (!drive.homes())
      table.problem("is permitted only with zero = \"homing\" in [encoder." + std::string{axis.name} + "]");
  }
}

}  // namespace crane::configuration
