#pragma once
/// Physical parameters of a tower crane, gantry, single drive axis or free pendulum (facts in
/// docs/equations.md). The leadscrew makes the inertia felt by the trolley drive and the mass that moves
/// along the jib two numbers.
#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace crane::plant {

enum Axis : std::size_t { kTrolley = 0, kSlew = 1, kHoist = 2 };
inline constexpr std::size_t kAxes = 3;
using PerAxis = std::array<double, kAxes>;

/// Ranges: parameter_fields.hpp.
struct Parameters {
  double gravity_mps2 = 9.81;         ///< g
  double trolley_inertia_kg = 22.46;  ///< M, inertia on x'' (trolley, leadscrew, motor) (4.3)
  double trolley_mass_kg = 1.97;      ///< M_j, mass in every rotational and centrifugal term
  double load_mass_kg = 2.0;          ///< m
  double jib_inertia_kgm2 = 7.2;      ///< J_o = J_eq n^2
  double trolley_gain_mps2pv = 2.0;   ///< K_mx: x'' = K_mx V without load and friction (4.4)
  double slew_gain_radps2pv = 1.14;   ///< K_mgamma: gamma'' = K_mgamma V at x = 0 without friction (4.5)
  double hoist_gain_mpspv = 0.05;     ///< steady cable speed per volt (speed-controlled drive)
  double hoist_lag_s = 0.1;           ///< time constant of the hoist drive

  /// Shares of M_j that the slew's motor turns and that pull at the trolley's motor when the jib turns: 0
  /// where a term puts a gap or a spring between. Not in a rig file.
  double slewed_share = 1, thrown_share = 1;

  /// m_t = m / M, m_r = m / J_o, M_r = M_j / J_o of (2.25) with the two trolley masses kept apart.
  [[nodiscard]] double load_to_trolley_ratio() const { return load_mass_kg / trolley_inertia_kg; }
  [[nodiscard]] double load_to_jib_ratio() const { return load_mass_kg / jib_inertia_kgm2; }
  [[nodiscard]] double trolley_to_jib_ratio() const { return trolley_mass_kg / jib_inertia_kgm2; }

  /// All problems at once as "name = value: rule"; empty when usable.
  [[nodiscard]] std::vector<std::string> problems() const;

  bool operator==(const Parameters&) const = default;
};

/// One entry of the rig file's [[model.terms]]: an effect the bare equations do not have.
struct TermSetting {
  std::string name;                          ///< "drive_friction", "load_linear_drag", ...
  std::string axis;                          ///< "trolley", "slew", "hoist", "radial", "tangential" or empty
  std::map<std::string, double> parameters;  ///< by name with unit, e.g. "coulomb_positive_v"

  bool operator==(const TermSetting&) const = default;
};

}  // namespace crane::plant
