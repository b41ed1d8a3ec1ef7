#include <algorithm>
#include <cmath>

#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

/// Sets the values of the design that follow from the rest of the rig: voltage limits of the drives, and the
/// range of cable lengths of the hoist.
void design_from(const Rig& rig, control::Design& design) {
  const Drive& hoist = rig.drives[plant::kHoist];
  const double length_m = rig.start.position[plant::kHoist];
  design.crane = rig.plant;
  design.period_s = rig.period_s;
  design.shortest_cable_length_m = hoist.present ? hoist.low_limit : length_m;
  design.longest_cable_length_m = hoist.present ? hoist.high_limit : length_m;
  design.cable_length_m = length_m;
  for (std::size_t i = 0; i < plant::kAxes; ++i) design.volt_limit_v[i] = rig.drives[i].volt_limit_v;
}

void read_friction(TomlTable& table, const plant::Coordinate& axis, double volt_limit_v, const Rig& rig,
                   control::DriveFriction& friction) {
  friction.factor = 1;  // the default of a rig file that has this section
  read_section(table, control::kFrictionFields, friction, &rig, axis.unit);
  for (const auto& [key, value, rule] : control::contradictions(friction, volt_limit_v))
    if (table.has(key)) table.problem(key, rule);
}

void read_frictions(TomlTable& controller, Rig& rig) {
  TomlTable frictions = controller.table("friction");
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    const plant::Coordinate& axis = plant::kCoordinates[i];
    TomlTable table = frictions.table(axis.name);
    if (!table.present()) continue;
    if (!rig.drives[i].present) table.problem("this rig has no such drive");
    read_friction(table, axis, rig.design.volt_limit_v[i], rig, rig.design.friction[i]);
  }
}

/// Checks between the controller, its design and the kind of rig.
void check_controller(TomlTable& table, const Rig& rig) {
  for (const auto& [key, value, rule] : control::contradictions(rig.design)) table.problem(key, rule);
  check_plausible_loops(table, rig.design);
  if (!rig.carries_load() && rig.planning.shaping != control::Shaping::none)
    table.problem("shaper", "must be none: a drive_axis carries no load");
  const auto* controller = control::find_controller(rig.controller);
  if (controller == nullptr || !control::problems(rig.design).empty()) return;  // reported elsewhere
  for (const auto& problem : control::problems(*controller, rig.design)) table.problem("name", problem);
}

}  // namespace

void read_controller(TomlTable& root, Rig& rig) {
  TomlTable table = root.table("controller");
  const bool moves_load = rig.carries_load() && rig.kind != RigKind::pendulum;
  if (!moves_load) rig.controller = "none";
  design_from(rig, rig.design);
  read_section(table, kControllerFields, rig, &rig);
  read_section(table, kPlanningFields, rig.planning, &rig);
  read_section(table, control::kDesignFields, rig.design, &rig);
  TomlTable believes = table.table("believes");
  read_section(believes, plant::kParameterFields, rig.design.crane, nullptr);
  check_plausible_gains(believes, rig.design.crane, rig);
  read_frictions(table, rig);
  check_controller(table, rig);
}

void read_adaptation(TomlTable& root, Rig& rig) {
  TomlTable table = root.table("adaptation");
  read_section(table, control::kAdaptationFields, rig.design.adaptation, &rig);
  const auto compensates = [](const control::DriveFriction& friction) { return friction.factor > 0; };
  if (rig.design.adaptation.enabled && std::ranges::none_of(rig.design.friction, compensates))
    table.problem("enabled", "must be false: no [controller.friction] of this rig has a factor above 0");
}

}  // namespace crane::configuration
