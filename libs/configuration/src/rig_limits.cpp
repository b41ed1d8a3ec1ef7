#include "rig_sections.hpp"

namespace crane::configuration {

void read_limits(TomlTable& root, Rig& rig) {
  TomlTable table = root.table("limits");
  Limits& limits = rig.limits;
  limits.swing_limit_rad = table.number("swing_limit_rad", Range::above(0, 1.5), limits.swing_limit_rad);
  limits.stale_after_ticks = table.integer("stale_after_ticks", 1, 100, limits.stale_after_ticks);
  limits.demand_stale_after_ticks =
      table.integer("demand_stale_after_ticks", 1, 100, limits.demand_stale_after_ticks);
  // The bridge is the last to notice that nobody commands the crane any more.
  constexpr double kLongestSilence_s = 0.1;
  if (limits.stale_after_ticks * rig.period_s > kLongestSilence_s + 1e-9)
    table.problem("stale_after_ticks",
                  "times period_s must be at most 0.1 s: a crane without commands must stop");
  limits.idle_lock_s = table.number("idle_lock_s", Range::above(0, 86400), limits.idle_lock_s);
}

void read_start(TomlTable& root, Rig& rig) {
  TomlTable table = root.table("start");
  Start& start = rig.start;
  // A slewing axis without a trolley has its jib inertia alone: gamma'' = K_mgamma V holds at x = 0.
  if (!rig.drives[plant::kTrolley].present) start.position[plant::kTrolley] = 0;
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    const Drive& drive = rig.drives[i];
    const AxisText& axis = kAxisTexts[i];
    const Range allowed = i == plant::kHoist ? Range::closed(1e-3, 1000) : Range::closed(-1000, 1000);
    start.position[i] = table.number(axis.position, allowed, start.position[i]);
    if (drive.present && drive.low_limit < drive.high_limit &&
        (start.position[i] < drive.low_limit || start.position[i] > drive.high_limit)) {
      table.problem(axis.position, "must be inside the limits of the " + std::string(axis.name) + " drive");
    }
  }
  start.cable_length_offset_m =
      table.number("cable_length_offset_m", Range::closed(-1000, 1000), start.cable_length_offset_m);
  if (start.position[plant::kHoist] + start.cable_length_offset_m <= 0)
    table.problem("cable_length_offset_m", "must leave a cable longer than 0");
  const Range swing = Range::closed(-1.5, 1.5);
  start.swing_radial_rad = table.number("swing_radial_rad", swing, 0);
  start.swing_tangential_rad = table.number("swing_tangential_rad", swing, 0);
}

}  // namespace crane::configuration
