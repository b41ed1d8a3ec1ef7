#include "truth/physics.hpp"

#include <numbers>
#include <stdexcept>

namespace truth {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;

Physics tower() {
  Physics p;
  p.drive[0] = {.present = true, .gain = 2.0, .coulomb_v = {0.9, 1.2}, .viscous_vs = {1.5, 6.0}};
  p.drive[1] = {
      .present = true, .gain = 1.14, .coulomb_v = {0.7, 0.6}, .viscous_vs = {0.15, 0.05}, .presliding = 3e-5};
  p.trolley_counts_pm = 8000 / 0.0127;
  p.slew_counts_prad = 8000 * 45 / kTurn_rad;
  p.swing_counts_prad = 24000 / kTurn_rad;
  p.low = {0.3, -1.2};
  p.high = {1.15, 1.2};
  return p;
}

Physics gantry() {
  Physics p;
  p.kind = RigKind::gantry;
  p.trolley_inertia_kg = 12;
  p.carriage_kg = 4;
  p.load_kg = 3;
  p.drive[0] = {.present = true, .gain = 1.2};
  p.tangential = false;
  p.cable_m = 1.5;
  p.trolley_counts_pm = 4000 / 0.1;
  p.swing_counts_prad = 16384 / kTurn_rad;
  p.low = {0.5, 0};
  p.high = {2.5, 0};
  p.second_cable_m = 0.9;
  p.bandwidth_radps = {4, 0};
  p.pace = 1.6;          // faster motions on a longer track
  p.load_effects = 1.5;  // without friction, the disturbance moves the trolley farther
  return p;
}

Physics drive_axis() {
  Physics p;
  p.kind = RigKind::drive_axis;
  p.trolley_inertia_kg = 10;
  p.carriage_kg = 1.5;
  p.load_kg = 0;
  p.drive[0] = {.present = true, .gain = 1.7, .coulomb_v = {1.0, 1.2}, .viscous_vs = {2.8, 5.5}};
  p.radial = p.tangential = false;
  p.trolley_counts_pm = 8000 / 0.0127;
  p.low = {-0.4, 0};
  p.high = {0.4, 0};
  return p;
}

Physics pendulum() {
  Physics p;
  p.kind = RigKind::pendulum;
  p.swing_counts_prad = 24000 / kTurn_rad;
  return p;
}

}  // namespace

Physics rig(std::string_view name) {
  if (name == "tower") return tower();
  if (name == "gantry") return gantry();
  if (name == "drive_axis") return drive_axis();
  if (name == "pendulum") return pendulum();
  throw std::invalid_argument("rig = " + std::string{name} + ": one of tower, gantry, drive_axis, pendulum");
}

}  // namespace truth
