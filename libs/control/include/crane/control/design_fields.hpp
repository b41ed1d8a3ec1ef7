#pragma once
/// Fields of [controller] and [controller.friction.NAME] of a rig file. The gains are those of H. M. Omar,
/// Control of Gantry and Tower Cranes, with the signs of docs/equations.md#coordinates-and-signs.
#include <string>
#include <vector>

#include "crane/control/drive_limit_fields.hpp"
#include "crane/control/law.hpp"
#include "crane/plant/parameter_fields.hpp"

namespace crane::control {

/// Gains in normalised time. The printed gains are below 100. With a gain above 1e5, a swing of one encoder
/// count commands full voltage.
inline constexpr fields::Range kGains = fields::Range::closed(-1e5, 1e5);
/// Delays in load periods. The damping of delayed feedback is periodic in the delay: two periods cover all
/// cases.
inline constexpr fields::Range kDelays = fields::Range::closed(0, 2);
/// Friction, V. contradictions() compares it with the voltage limit of the drive.
inline constexpr fields::Range kFrictionVolts = fields::Range::closed(0, 1000);

/// K_d of (3.42), for critical damping.
[[nodiscard]] double critical_derivative(const Design& design);

inline constexpr std::array<fields::Field<Design>, 18> kDesignFields{{
    {.key = "cable_length_m",
     .member = &Design::cable_length_m,
     .range = plant::kCableLengths,
     .unit = "m",
     .meaning = "cable length for which the controller is designed, inside the limits of the hoist; without "
                "a hoist that of "
                "`[start]`",
     .default_text = "that of `[start]`"},
    {.key = "full_state_forward_gain_vpm",
     .member = &Design::full_state_forward_gain_vpm,
     .range = fields::Range::above(0, 1000),
     .unit = "V/m, V/rad",
     .meaning = "largest forward gain K of the full-state feedback (3.26), V/m on the trolley, V/rad on the "
                "slew axis; "
                "the law lowers K for moves whose first command would exceed the volts of the drive"},
    {.key = "tracking_proportional",
     .member = &Design::tracking_proportional,
     .range = fields::Range::above(0, 1e5),
     .meaning = "K_p (3.41), in normalised time"},
    {.key = "tracking_derivative",
     .member = &Design::tracking_derivative,
     .range = fields::Range::closed(0, 1e5),
     .meaning = "K_d (3.41), in normalised time",
     .default_text = "2 √K_p (3.42)",
     .derived = critical_derivative},
    {.key = "delayed_1_gain", .member = &Design::delayed_1_gain, .range = kGains, .meaning = "K_del (3.47)"},
    {.key = "delayed_1_delay",
     .member = &Design::delayed_1_delay,
     .range = kDelays,
     .unit = "periods of the load",
     .meaning = "τ_del (3.47)"},
    {.key = "delayed_2_gain",
     .member = &Design::delayed_2_gain,
     .range = fields::Range::closed(-1e3, 1e3),
     .meaning = "K_del (3.50)"},
    {.key = "delayed_2_delay",
     .member = &Design::delayed_2_delay,
     .range = kDelays,
     .unit = "periods of the load",
     .meaning = "τ_del (3.50)"},
    {.key = "anti_swing_proportional",
     .member = &Design::anti_swing_proportional,
     .range = kGains,
     .meaning = "K_ps (3.45), in normalised time"},
    {.key = "anti_swing_derivative",
     .member = &Design::anti_swing_derivative,
     .range = kGains,
     .meaning = "K_ds (3.45), in normalised time"},
    {.key = "fuzzy_gain",
     .member = &Design::fuzzy_gain,
     .range = kGains,
     .meaning = "K_V / φ_max (3.51), not 0"},
    {.key = "fuzzy_swing_rad",
     .member = &Design::fuzzy_swing_rad,
     .range = fields::Range::above(0, 3.2),
     .unit = "rad",
     .meaning = "φ_max (3.51): swing with full membership in PB",
     .default_text = "10°"},
    {.key = "fuzzy_swing_rate",
     .member = &Design::fuzzy_swing_rate,
     .range = fields::Range::above(0, 1e3),
     .unit = "rad per period of the load",
     .meaning = "swing rate with full membership in PB (3.51)"},
    {.key = "fuzzy_point_a",
     .member = &Design::fuzzy_point_a,
     .range = fields::Range::closed(0.01, 0.98),
     .meaning = "peak of PS (figure 3.20)",
     .default_text = "1/3"},
    {.key = "fuzzy_point_b",
     .member = &Design::fuzzy_point_b,
     .range = fields::Range::closed(0.02, 0.99),
     .meaning = "peak of PM (figure 3.20), at least `fuzzy_point_a` + 0.01",
     .default_text = "2/3"},
    {.key = "hoist_proportional_ps",
     .member = &Design::hoist_proportional_ps,
     .range = fields::Range::above(0, 100),
     .unit = "1/s",
     .meaning = "gain of the cable position loop"},
    {.key = "minimum_trolley_position_m",
     .member = &Design::minimum_trolley_position_m,
     .range = fields::Range::closed(1e-3, 100),
     .unit = "m",
     .meaning = "x_min: for x < x_min, x / x_min² replaces the factor 1/x of the gains of the slew axis"},
    {.key = "swing_observer",
     .member = &Design::swing_observer,
     .meaning = "true: the control laws use the state that the pendulum observer predicts for the time when "
                "their command acts; false: they use the filtered and differentiated measurements"},
}};

inline constexpr std::array<fields::Field<DriveFriction>, 9> kFrictionFields{{
    {.key = "viscous_positive",
     .member = &DriveFriction::viscous_positive_vspm,
     .range = kFrictionVolts,
     .meaning = "b / K_m, viscous friction",
     .quantity = fields::Quantity::volts_per_speed},
    {.key = "viscous_negative",
     .member = &DriveFriction::viscous_negative_vspm,
     .range = kFrictionVolts,
     .meaning = "b / K_m, viscous friction",
     .quantity = fields::Quantity::volts_per_speed},
    {.key = "coulomb_positive_v",
     .member = &DriveFriction::coulomb_positive_v,
     .range = kFrictionVolts,
     .unit = "V",
     .meaning = "c / K_m, Coulomb friction; times `factor` below `volt_limit_v`"},
    {.key = "coulomb_negative_v",
     .member = &DriveFriction::coulomb_negative_v,
     .range = kFrictionVolts,
     .unit = "V",
     .meaning = "c / K_m, Coulomb friction; times `factor` below `volt_limit_v`"},
    {.key = "stiction_positive_v",
     .member = &DriveFriction::stiction_positive_v,
     .range = kFrictionVolts,
     .unit = "V",
     .meaning = "f_s / K_m, friction at standstill; times `factor` below `volt_limit_v`",
     .default_text = "the Coulomb friction",
     .derived = [](const DriveFriction& friction) { return friction.coulomb_positive_v; }},
    {.key = "stiction_negative_v",
     .member = &DriveFriction::stiction_negative_v,
     .range = kFrictionVolts,
     .unit = "V",
     .meaning = "f_s / K_m, friction at standstill; times `factor` below `volt_limit_v`",
     .default_text = "the Coulomb friction",
     .derived = [](const DriveFriction& friction) { return friction.coulomb_negative_v; }},
    {.key = "stiction_slope_per_v",
     .member = &DriveFriction::stiction_slope_per_v,
     .range = fields::Range::above(0, 1e6),
     .unit = "1/V",
     .meaning = "A of (3.2), slope of the tanh at standstill"},
    // 1 m/s or 1 rad/s is the top speed of a fast drive: with a wider band every motion counts as standstill.
    {.key = "zero_band",
     .member = &DriveFriction::zero_band_mps,
     .range = fields::Range::above(0, 1),
     .meaning = "d_s of (3.3): the axis is at standstill below this speed",
     .quantity = fields::Quantity::speed},
    {.key = "factor",
     .member = &DriveFriction::factor,
     .range = fields::Range::closed(0, 1.5),
     .meaning = "compensated share: 0 off, 1 exact",
     .default_text = "1"},
}};

/// A broken rule between several fields. Fields outside their range are not reported here.
struct Contradiction {
  std::string_view key;
  double value;
  std::string rule;
};
[[nodiscard]] std::vector<Contradiction> contradictions(const Design& design);
/// Friction that reaches the voltage limit: the drive cannot move, and no voltage remains for the gain K of
/// the full-state feedback.
[[nodiscard]] std::vector<Contradiction> contradictions(const DriveFriction& friction, double volt_limit_v);

}  // namespace crane::control
