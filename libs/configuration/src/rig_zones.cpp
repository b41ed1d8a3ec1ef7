#include <algorithm>
#include <cmath>

#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

using control::kMostZones;
using control::Zone;
using control::ZoneShape;

void check_size(TomlTable& table, const char* key, double size, bool needed, const char* shape) {
  if (needed && size == 0)
    table.problem(key, std::string{"must be above 0: the shape is a "} + shape);
  else if (!needed && table.has(key))
    table.problem(key, std::string{"must not be given: the shape is a "} + shape);
}

void check_shape(TomlTable& table, const Zone& zone, RigKind kind) {
  const bool box = zone.shape == ZoneShape::box;
  const char* const shape = box ? "box" : "cylinder";
  check_size(table, "size_x_m", zone.size_x_m, box, shape);
  check_size(table, "size_y_m", zone.size_y_m, box, shape);
  check_size(table, "radius_m", zone.radius_m, !box, shape);
  if (zone.top_m <= zone.bottom_m) table.problem("top_m", "must be above bottom_m");
  if (kind == RigKind::gantry && zone.position_y_m != 0)
    table.problem("position_y_m", "must be 0: a gantry moves along x only");
}

struct Interval {
  double low = 0, high = 0;
};

Interval travel_of(const Rig& rig, plant::Axis axis) {
  const Drive& drive = rig.drives[axis];
  return drive.present ? Interval{drive.low_limit, drive.high_limit}
                       : Interval{rig.start.position[axis], rig.start.position[axis]};
}

/// Smallest clearance of the longest cable from the zone, over a grid of positions of trolley and slew. A
/// zone farther away than the distance between two points of the grid cannot be reached.
bool can_be_reached(const Rig& rig, const Zone& zone) {
  constexpr int kPoints = 128;
  const Interval trolley = travel_of(rig, plant::kTrolley), slew = travel_of(rig, plant::kSlew);
  const double longest_m = travel_of(rig, plant::kHoist).high;
  const double turn = rig.drives[plant::kSlew].present ? slew.high - slew.low : 0;
  const double spacing_m = (trolley.high - trolley.low) / kPoints + std::abs(trolley.high) * turn / kPoints;
  const auto at = [](const Interval& range, int i) {
    return range.low + (range.high - range.low) * i / kPoints;
  };
  for (int i = 0; i <= kPoints; ++i)
    for (int k = 0; k <= kPoints; ++k) {
      const auto reach = control::resting_space(rig.clearance, rig.plant.gravity_mps2, at(trolley, i),
                                                turn > 0 ? at(slew, k) : 0, longest_m);
      if (control::clearance_m(zone, reach, rig.clearance.suspension_height_m) <= spacing_m) return true;
    }
  return false;
}

bool contains(const Rig& rig, const Zone& zone, const plant::PerAxis& position) {
  const auto reach = control::resting_space(rig.clearance, rig.plant.gravity_mps2, position[plant::kTrolley],
                                            rig.drives[plant::kSlew].present ? position[plant::kSlew] : 0,
                                            position[plant::kHoist]);
  return control::clearance_m(zone, reach, rig.clearance.suspension_height_m) <= 0;
}

/// Reports the positions of homing: the mark of each axis, with the other axes at [start], and the position
/// at which `crane home` leaves the crane, where every axis is `back_off` beyond its mark. Also reports a
/// zone that contains all marks, because each axis passes its mark.
void check_homing_positions(TomlTable& table, const Rig& rig, const Zone& zone) {
  plant::PerAxis marks = rig.start.position, rest = rig.start.position;
  bool found = false;
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    if (!rig.drives[i].homes()) continue;
    const auto& homing = rig.drives[i].homing;
    plant::PerAxis home = rig.start.position;
    home[i] = marks[i] = homing.position;
    rest[i] = homing.position - homing.direction() * homing.back_off;
    if (!contains(rig, zone, home)) continue;
    found = true;
    table.problem("position_x_m", "zone " + zone.name +
                                      " touches the space of a load at rest at the homing position of the " +
                                      std::string{plant::kCoordinates[i].name});
  }
  if (found || marks == rig.start.position) return;
  if (contains(rig, zone, marks) || contains(rig, zone, rest))
    table.problem(
        "position_x_m",
        "zone " + zone.name + " touches the space of a load at rest at the position after homing all axes");
}

void check_place(TomlTable& table, const Rig& rig, const Zone& zone) {
  if (!can_be_reached(rig, zone)) {
    table.problem("position_x_m", "zone " + zone.name + " is outside of the space that the load can reach");
    return;
  }
  if (contains(rig, zone, rig.start.position))
    table.problem("position_x_m",
                  "zone " + zone.name + " touches the space of a load at rest at the position of [start]");
  check_homing_positions(table, rig, zone);
}

bool is_whole(const Zone& zone) {
  const auto known = [](double value) { return std::isfinite(value); };
  return known(zone.position_x_m) && known(zone.position_y_m) && known(zone.size_x_m) &&
         known(zone.size_y_m) && known(zone.radius_m) && known(zone.bottom_m) && known(zone.top_m);
}

/// Reports a rig whose zones the supervisor cannot check. The check needs a load on a moving suspension point
/// and measured swing angles.
void check_rig(TomlTable& table, const Rig& rig) {
  if (rig.kind != RigKind::tower && rig.kind != RigKind::gantry)
    table.problem("zones need a tower or a gantry");
  else if (!rig.has_load() || !rig.measures(plant::kSwingRadial) ||
           (rig.kind == RigKind::tower && !rig.measures(plant::kSwingTangential)))
    table.problem("zones need a load and an encoder of each swing angle");
  if (rig.sensing.filter_swing_angle)
    table.problem("zones need unfiltered swing angles: filter_swing_angle = false in [sensing]");
}

}  // namespace

void read_zones(TomlTable& root, Rig& rig) {
  TomlTable clearance = root.table("clearance");
  read_section(clearance, control::kClearanceFields, rig.clearance, &rig);
  const auto known = [](double value) { return std::isfinite(value); };
  const bool placed = known(rig.clearance.load_radius_m) && known(rig.clearance.suspension_height_m) &&
                      known(rig.clearance.cable_error) && known(rig.clearance.wind_mps2);
  auto tables = root.tables("zone");
  if (tables.size() > kMostZones)
    root.problem("zone", "has " + std::to_string(tables.size()) + " tables: must be at most " +
                             std::to_string(kMostZones));
  for (TomlTable& table : tables) {
    Zone zone;
    read_section(table, control::kZoneFields, zone, &rig);
    if (rig.zones.size() >= kMostZones) continue;
    if (table.has("name") && zone.name.empty()) table.problem("name", "must not be empty");
    if (std::ranges::find(rig.zones, zone.name, &Zone::name) != rig.zones.end() && !zone.name.empty())
      table.problem("name", "two zones have this name");
    check_rig(table, rig);
    check_shape(table, zone, rig.kind);
    if (placed && is_whole(zone) && rig.carries_load() && rig.kind != RigKind::pendulum)
      check_place(table, rig, zone);
    rig.zones.push_back(std::move(zone));
  }
  if (!rig.zones.empty() && !clearance.has("load_radius_m"))
    clearance.problem("load_radius_m", "missing: zones need the radius of the load");
}

}  // namespace crane::configuration
