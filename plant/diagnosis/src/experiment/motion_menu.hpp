#pragma once
/// Motions that tell confounded causes apart, inside a rig's limits.
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

/// Drives start at rest; a load that starts with swing was pulled aside and let go.
struct SafeMotion {
  std::string name;         ///< "slow_sweep_trolley"
  std::string description;  ///< one sentence
  plant::PerAxis start{};   ///< m, rad, m of cable
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  double load_mass_kg = 0;                  ///< other than the rig's where a known mass was added
  std::vector<TimedExcitation> references;  ///< in order of time; axes without one stay
  double duration_s = 0;

  /// Reference of a drive; where nothing is asked it stays where it was brought.
  [[nodiscard]] control::AxisReference reference(plant::Axis axis, double time_s) const;
};

/// What the rig can do: sweeps, break-away, two speeds, shaking per drive; a swinging load; a second length
/// of cable, half a turn and an added mass where there are a hoist, a slew drive and a load.
[[nodiscard]] std::vector<SafeMotion> motion_menu(const configuration::Rig& rig);

/// The motion as a scenario file for `crane run`, controller none: tracking alone.
[[nodiscard]] std::string scenario_text(const SafeMotion& motion, const configuration::Rig& rig);

}  // namespace crane::diagnosis
