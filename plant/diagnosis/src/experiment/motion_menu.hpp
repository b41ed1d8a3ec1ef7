#pragma once
/// Menu of motions that separate confounded causes, inside a rig's limits.
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/control/excitation.hpp"

namespace crane::diagnosis {

/// The reference of one axis from a time on.
struct TimedExcitation {
  double at_s = 0;
  control::Excitation reference;
};

/// Drives start at rest. A load with initial swing was pulled aside and released.
struct SafeMotion {
  std::string name;         ///< "slow_sweep_trolley"
  std::string description;  ///< one sentence
  plant::PerAxis start{};   ///< m, rad, m of cable
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  double load_mass_kg = 0;                  ///< differs from the rig's with a known added mass
  std::vector<TimedExcitation> references;  ///< in order of time; other axes rest
  double duration_s = 0;

  /// Reference of a drive; its last position after the last part.
  [[nodiscard]] control::AxisReference reference(plant::Axis axis, double time_s) const;
};

/// Per drive: slow sweep, break-away, two speeds, shaking. With a load: swinging, added mass. With a hoist:
/// second cable length. With a slew drive: half a turn.
[[nodiscard]] std::vector<SafeMotion> motion_menu(const configuration::Rig& rig);

/// The motion as a scenario file for `crane run`, with controller none.
[[nodiscard]] std::string scenario_text(const SafeMotion& motion, const configuration::Rig& rig);

}  // namespace crane::diagnosis
