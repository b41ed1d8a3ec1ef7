#include <algorithm>
#include <cmath>

#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

using control::Mark;
using control::Zero;

Zero read_zero(TomlTable& encoder, const Rig& rig) {
  const auto name = encoder.choice("zero", {"start", "absolute", "homing"}, "start");
  if (name == "homing") return Zero::homing;
  if (name != "absolute") return Zero::start;
  if (rig.board != "simulated")
    encoder.problem("zero", "the counters of this board are incremental: start or homing");
  return Zero::absolute;
}

Mark read_mark(TomlTable& table) {
  const auto name = table.choice("mark", {"limit_low", "limit_high", "input"});
  if (name == "limit_high") return Mark::limit_high;
  return name == "input" ? Mark::input : Mark::limit_low;
}

void read_position(TomlTable& table, const AxisText& axis, Drive& drive) {
  const std::string key = with_unit("position", axis.unit);
  auto& homing = drive.homing;
  const Range travel = Range::closed(drive.low_limit, drive.high_limit);
  if (homing.mark == Mark::input) {
    homing.position = table.number(key, travel);
  } else {
    const double end = homing.mark == Mark::limit_low ? drive.low_limit : drive.high_limit;
    homing.position = table.number(key, travel, end);
    if (std::abs(homing.position - end) > drive.soft_margin)
      table.problem(key, "must be within the soft margin of its limit");
  }
}

void read_homing_of(TomlTable& table, const AxisText& axis, const DriveLines& lines, Drive& drive) {
  constexpr double kShareOfPlanned = 0.1, kShareOfSearch = 0.2, kBackOff = 0.02, kUsual_v = 5;
  auto& homing = drive.homing;
  homing.mark = read_mark(table);
  if (homing.mark == Mark::input && lines.mark_input < 0)
    table.problem("mark", "needs mark_input in [wiring." + std::string{axis.name} + "]");
  if (drive.low_limit < drive.high_limit) read_position(table, axis, drive);
  const double fastest = drive.reference_speed;
  homing.speed = table.number(with_unit("speed", axis.speed), Range::above(0, std::max(1e-6, fastest)),
                              kShareOfPlanned * fastest);
  homing.approach_speed =
      table.number(with_unit("approach_speed", axis.speed), Range::above(0, std::max(1e-6, homing.speed)),
                   kShareOfSearch * homing.speed);
  homing.back_off = table.number(with_unit("back_off", axis.unit), Range::positive(), kBackOff);
  homing.volt_limit_v = table.number("volt_limit_v", Range::above(0, drive.volt_limit_v),
                                     std::min(kUsual_v, drive.volt_limit_v));
}

}  // namespace

void read_homing(TomlTable& root, Rig& rig) {
  TomlTable encoders = root.table("encoder");
  bool any = false;
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    if (!rig.drives[i].present) continue;
    TomlTable encoder = encoders.table(kAxisTexts[i].name);
    rig.drives[i].zero = read_zero(encoder, rig);
    any = any || rig.drives[i].homes();
  }
  TomlTable homing = any ? root.required_table("homing") : root.table("homing");
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    Drive& drive = rig.drives[i];
    if (!drive.present) continue;
    const AxisText& axis = kAxisTexts[i];
    TomlTable table = drive.homes() ? homing.required_table(axis.name) : homing.table(axis.name);
    if (!table.present()) continue;
    read_homing_of(table, axis, rig.wiring.drives[i], drive);
    if (!drive.homes())
      table.problem("is for an axis with zero = \"homing\" in [encoder." + std::string{axis.name} + "]");
  }
}

}  // namespace crane::configuration
