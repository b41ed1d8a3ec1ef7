#pragma once
/// Identified parameters of a rig, and their conversion to a rig file.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "tuning/priors.hpp"

namespace crane::tuning {

struct Value {
  double value = 0;
  double standard_error = 0;
};

/// One drive: friction as F / K_m in volts.
struct IdentifiedDrive {
  Value gain;  ///< K_m, m/s^2 or rad/s^2 per V (slew: at x = 0)
  Value coulomb_positive_v, coulomb_negative_v;
  Value viscous_positive_vspm, viscous_negative_vspm;
  Value delay_s;
};

/// A load on a second cable below a hook: the term double_pendulum.
struct SecondMode {
  Value lower_share;                    ///< share of the load mass below the hook
  Value lower_length_m;                 ///< hook to load
  Value hook_raised_m;                  ///< distance of the hook above the end of the cable length
  std::array<Value, 2> rest_angle_rad;  ///< radial, tangential; fitted together with the second mode
  double residual_rms = 0;              ///< rms residual of the swing, rad
};
/// Upper bound of SecondMode::lower_share, from the range of the term.
[[nodiscard]] double largest_lower_share();
[[nodiscard]] plant::TermSetting double_pendulum_term(double lower_share, double lower_length_m,
                                                      double hook_raised_m);

struct Identified {
  /// Suspension point to centre of the load; with a second mode: length of the simple pendulum with the
  /// frequency of the first mode.
  Value cable_m;
  std::optional<SecondMode> second_mode;
  std::array<Value, 2> rest_angle_rad;  ///< radial, tangential
  Value load_mass_kg;
  std::array<std::optional<IdentifiedDrive>, 2> drives;  ///< trolley, slew
};

/// One parameter of the list that tables and files show.
struct NamedValue {
  std::string name, unit;
  Value value;
};
[[nodiscard]] std::vector<NamedValue> named_values(const Identified& identified);

/// The rig file with the identified values, for the simulated plant and for the design of the controllers.
[[nodiscard]] configuration::Rig with_identified(configuration::Rig rig, const Identified& identified);

/// Terms of the simulated plant that the tuning identifies and therefore replaces.
[[nodiscard]] bool is_identified_term(const plant::TermSetting& term);

/// @return estimates outside the priors, one line each
[[nodiscard]] std::vector<std::string> outside(const Identified& identified, const configuration::Rig& rig,
                                               const Priors& priors);

}  // namespace crane::tuning
