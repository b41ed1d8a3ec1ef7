#include <algorithm>
#include <cmath>
#include <utility>

#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

std::vector<std::string> controller_names() {
  std::vector<std::string> names;
  for (const auto& controller : control::controllers()) names.emplace_back(controller.name);
  return names;
}

/// The laws take a measured cable length into what this rig can have.
void read_cable(TomlTable& table, const Rig& rig, control::Design& design) {
  const Drive& hoist = rig.drives[plant::kHoist];
  const double length_m = rig.start.position[plant::kHoist];
  design.shortest_cable_length_m = hoist.present ? hoist.low_limit : length_m;
  design.longest_cable_length_m = hoist.present ? hoist.high_limit : length_m;
  const Range range = Range::closed(design.shortest_cable_length_m, design.longest_cable_length_m);
  design.cable_length_m = table.number("cable_length_m", range, length_m);
}

void read_gains(TomlTable& table, control::Design& design) {
  design.full_feedback_gain_pm =
      table.number("full_feedback_gain_pm", Range::above(0, 1000), design.full_feedback_gain_pm);
  design.tracking_proportional =
      table.number("tracking_proportional", Range::above(0, 1e5), design.tracking_proportional);
  // (3.42): critically damped unless the file says otherwise.
  design.tracking_derivative =
      table.number("tracking_derivative", Range::closed(0, 1e5), 2 * std::sqrt(design.tracking_proportional));
  design.hoist_proportional_ps =
      table.number("hoist_proportional_ps", Range::above(0, 100), design.hoist_proportional_ps);
  design.minimum_trolley_position_m =
      table.number("minimum_trolley_position_m", Range::closed(1e-3, 100), design.minimum_trolley_position_m);
}

/// Gains in normalised time and in the tower's sign; delays in periods of the load.
void read_anti_swing(TomlTable& table, control::Design& design) {
  const auto read = [&table](const char* key, const Range& range, double& value) {
    value = table.number(key, range, value);
  };
  const Range gain = Range::closed(-1e5, 1e5), delay = Range::above(0, 2);
  read("anti_swing_proportional", gain, design.anti_swing_proportional);
  read("anti_swing_derivative", gain, design.anti_swing_derivative);
  read("delayed_1_gain", gain, design.delayed_1_gain);
  read("delayed_1_delay", delay, design.delayed_1_delay);
  read("delayed_2_gain", Range::closed(-1e3, 1e3), design.delayed_2_gain);
  read("delayed_2_delay", delay, design.delayed_2_delay);
  read("fuzzy_gain", gain, design.fuzzy_gain);
  if (design.fuzzy_gain == 0) table.problem("fuzzy_gain", "must not be 0");
  read("fuzzy_swing_rad", Range::above(0, 3.2), design.fuzzy_swing_rad);
  read("fuzzy_swing_rate", Range::above(0, 1e3), design.fuzzy_swing_rate);
  read("fuzzy_point_a", Range::closed(0.01, 0.98), design.fuzzy_point_a);
  read("fuzzy_point_b", Range::closed(0.02, 0.99), design.fuzzy_point_b);
  if (design.fuzzy_point_b < design.fuzzy_point_a + 0.01)
    table.problem("fuzzy_point_b", "must be at least fuzzy_point_a + 0.01");
}

void read_planning(TomlTable& table, Rig& rig) {
  rig.planning.limits_jerk =
      table.choice("trajectory", {"bang_coast_bang", "s_curve"}, "bang_coast_bang") == "s_curve";
  const std::vector<std::string> names{"none", "zv", "zvd", "ei"};  // in the order of control::Shaping
  const auto chosen = std::find(names.begin(), names.end(), table.choice("shaper", names, "none"));
  if (chosen == names.end()) return;  // reported
  rig.planning.shaping = static_cast<control::Shaping>(chosen - names.begin());
  if (rig.kind == RigKind::drive_axis && rig.planning.shaping != control::Shaping::none)
    table.problem("shaper", "must be none: a drive_axis carries no load");
}

void read_friction(TomlTable& table, const AxisText& axis, double limit_v, control::DriveFriction& friction) {
  const Range volts = Range::closed(0, 1000);
  const auto viscous = [&axis](std::string_view direction) {
    return with_unit(direction, axis.volt_per_speed);
  };
  friction.viscous_positive_vspm = table.number(viscous("viscous_positive"), volts, 0);
  friction.viscous_negative_vspm = table.number(viscous("viscous_negative"), volts, 0);
  friction.coulomb_positive_v = table.number("coulomb_positive_v", volts, 0);
  friction.coulomb_negative_v = table.number("coulomb_negative_v", volts, 0);
  // The pull-away friction is the Coulomb friction unless the file says otherwise.
  friction.stiction_positive_v = table.number("stiction_positive_v", volts, friction.coulomb_positive_v);
  friction.stiction_negative_v = table.number("stiction_negative_v", volts, friction.coulomb_negative_v);
  friction.stiction_slope_per_v =
      table.number("stiction_slope_per_v", Range::above(0, 1e6), friction.stiction_slope_per_v);
  friction.zero_band_mps =
      table.number(with_unit("zero_band", axis.speed), Range::above(0, 1), friction.zero_band_mps);
  friction.factor = table.number("factor", Range::closed(0, 1.5), 1);
  for (const auto& [key, held_v] : {std::pair{"coulomb_positive_v", friction.coulomb_positive_v},
                                    std::pair{"coulomb_negative_v", friction.coulomb_negative_v},
                                    std::pair{"stiction_positive_v", friction.stiction_positive_v},
                                    std::pair{"stiction_negative_v", friction.stiction_negative_v}})
    if (table.has(key) && friction.factor * held_v >= limit_v)
      table.problem(key, "times factor must be below the volt_limit_v of the drive");
}

/// What the controller of this file needs beyond a design in order.
void check_controller(TomlTable& table, const Rig& rig) {
  const auto* controller = control::find_controller(rig.controller);
  if (controller == nullptr || !control::problems(rig.design).empty()) return;  // reported elsewhere
  for (const auto& problem : control::problems(*controller, rig.design)) table.problem("name", problem);
}

}  // namespace

void read_controller(TomlTable& root, Rig& rig) {
  TomlTable table = root.table("controller");
  const bool swings = rig.kind == RigKind::tower || rig.kind == RigKind::gantry;
  rig.controller = table.choice("name", controller_names(), swings ? rig.controller : "none");
  control::Design& design = rig.design;
  design.crane = rig.plant;
  design.period_s = rig.period_s;
  read_cable(table, rig, design);
  for (std::size_t i = 0; i < plant::kAxes; ++i) design.volt_limit_v[i] = rig.drives[i].volt_limit_v;
  read_gains(table, design);
  read_anti_swing(table, design);
  read_planning(table, rig);
  TomlTable believes = table.table("believes");
  override_plant(believes, design.crane);
  TomlTable friction = table.table("friction");
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    TomlTable section = friction.table(kAxisTexts[i].name);
    if (!section.present()) continue;
    if (!rig.drives[i].present) section.problem("this rig has no such drive");
    read_friction(section, kAxisTexts[i], design.volt_limit_v[i], design.friction[i]);
  }
  check_controller(table, rig);
}

}  // namespace crane::configuration
