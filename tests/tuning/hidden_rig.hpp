#pragma once
/// Cranes with unknown parameters, drawn from a seed. This code shares nothing with the tuning but the format
/// of the rig files.
#include <array>
#include <cstdint>
#include <string>

#include "crane/configuration/rig.hpp"

namespace crane::tuning {

/// The true parameters of one drive; friction in volts.
struct TrueDrive {
  double gain = 0;
  double coulomb_positive_v = 0, coulomb_negative_v = 0;
  double viscous_positive_vspm = 0, viscous_negative_vspm = 0;
  double delay_s = 0;
};

struct HiddenRig {
  std::string description;   ///< one line with all drawn numbers
  configuration::Rig known;  ///< the rig file that the tuning gets
  configuration::Rig truth;  ///< the rig that the board simulates
  double cable_m = 0, load_mass_kg = 0;
  std::array<double, 2> rest_angle_rad{};
  std::array<TrueDrive, 2> drives;
  /// The rig file that states the truth, for the search by brute force.
  configuration::Rig ideal;
};

/// Odd seeds draw gantries, even seeds towers.
[[nodiscard]] HiddenRig hidden_rig(std::uint64_t seed);

}  // namespace crane::tuning
