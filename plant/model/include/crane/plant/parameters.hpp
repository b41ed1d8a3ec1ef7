#pragma once
/// Physical parameters of a tower crane, gantry, single drive axis or free pendulum. docs/equations.md states
/// values and sources. Because of the leadscrew, the inertia that the trolley drive accelerates (M) differs
/// from the mass that moves along the jib (M_j). Equation numbers: H. M. Omar, Control of Gantry
/// and Tower Cranes, Virginia Tech, 2003.
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
  double trolley_inertia_kg = 22.46;  ///< M, factor of x'' (trolley, leadscrew, motor) (4.3)
  double trolley_mass_kg = 1.97;      ///< M_j, mass in every rotational and centrifugal term
  double load_mass_kg = 2.0;          ///< m
  double jib_inertia_kgm2 = 7.2;      ///< J_o = J_eq n^2
  double trolley_gain_mps2pv = 2.0;   ///< K_mx: x'' = K_mx V without load and friction (4.4)
  double slew_gain_radps2pv = 1.14;   ///< K_mgamma: gamma'' = K_mgamma V at x = 0 without friction (4.5)
  double hoist_gain_mpspv = 0.05;     ///< steady cable speed per volt (speed-controlled drive)
  double hoist_lag_s = 0.1;           ///< time constant of the hoist drive

  /// Share of M_j that the slew motor accelerates; 0 when a structure term separates the motor from the jib.
  /// Set by terms, not by rig files.
  double rotating_share = 1;
  /// Share of M_j whose centrifugal force and weight along a tilted jib act on the trolley motor; 0 when a
  /// structure term separates the motor from the trolley. Set by terms, not by rig files.
  double centrifugal_share = 1;
  /// Sine and cosine of the inclination of the jib, positive when the tip is raised. The slew axis is
  /// vertical. Set by terms, not by rig files.
  double tilt_sine = 0, tilt_cosine = 1;

  /// Ratios (2.25), with M and M_j for the two trolley masses: m_t = m / M, m_r = m / J_o, M_r = M_j / J_o.
  [[nodiscard]] double load_to_trolley_ratio() const { return load_mass_kg / trolley_inertia_kg; }
  [[nodiscard]] double load_to_jib_ratio() const { return load_mass_kg / jib_inertia_kgm2; }
  [[nodiscard]] double trolley_to_jib_ratio() const { return trolley_mass_kg / jib_inertia_kgm2; }

  /// @return all problems as "name = value: rule"; empty when there are none
  [[nodiscard]] std::vector<std::string> problems() const;

  bool operator==(const Parameters&) const = default;
};

/// One entry [[model.terms]] of a rig file: an effect that is not part of the basic equations of motion.
struct TermSetting {
  std::string name;                          ///< "drive_friction", "load_linear_drag", ...
  std::string axis;                          ///< "trolley", "slew", "hoist", "radial", "tangential" or empty
  std::map<std::string, double> parameters;  ///< by name with unit, e.g. "coulomb_positive_v"

  bool operator==(const TermSetting&) const = default;
};

}  // namespace crane::plant
