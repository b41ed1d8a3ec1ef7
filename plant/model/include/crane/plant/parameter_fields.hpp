#pragma once
/// Section [plant] of a rig file, and ranges that several sections use. Within the ranges every quotient of
/// the equations is finite. Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes.
#include "crane/fields/field.hpp"
#include "crane/plant/parameters.hpp"

namespace crane::plant {

/// Swing angles, rad. The equations divide by cos(swing), which is 0.07 at 1.5 rad.
inline constexpr fields::Range kSwingAngles = fields::Range::closed(-1.5, 1.5);
/// Positions, m or rad. The jib of a tower crane is shorter than 100 m.
inline constexpr fields::Range kPositions = fields::Range::closed(-1000, 1000);
/// Cable lengths, m. The equations divide by the length.
inline constexpr fields::Range kCableLengths = fields::Range::closed(1e-3, 1000);
/// Sampling periods, s. A period of 0.1 s gives only a few samples per period of the load.
inline constexpr fields::Range kPeriods = fields::Range::closed(1e-5, 0.1);

// The largest mass is 1000 t, more than any tower crane carries. Divisors are at least 1e-6.
inline constexpr std::array<fields::Field<Parameters>, 9> kParameterFields{{
    {.key = "gravity_mps2",
     .member = &Parameters::gravity_mps2,
     .range = fields::Range::closed(1e-3, 100),
     .unit = "m/s²",
     .meaning = "g, gravitational acceleration"},
    {.key = "trolley_inertia_kg",
     .member = &Parameters::trolley_inertia_kg,
     .range = fields::Range::closed(1e-6, 1e6),
     .unit = "kg",
     .meaning = "M, inertia that the trolley drive accelerates, including leadscrew and motor (4.3)",
     .presence = fields::Presence::required_with_trolley},
    {.key = "trolley_mass_kg",
     .member = &Parameters::trolley_mass_kg,
     .range = fields::Range::closed(0, 1e6),
     .unit = "kg",
     .meaning = "M_j, mass that moves along the jib; used in the rotational and centrifugal terms",
     .presence = fields::Presence::required_with_trolley},
    {.key = "load_mass_kg",
     .member = &Parameters::load_mass_kg,
     .range = fields::Range::closed(0, 1e6),
     .unit = "kg",
     .meaning = "m, mass of the load; 0 for a drive_axis",
     .presence = fields::Presence::required_with_load},
    {.key = "jib_inertia_kgm2",
     .member = &Parameters::jib_inertia_kgm2,
     .range = fields::Range::closed(1e-6, 1e8),
     .unit = "kg m²",
     .meaning = "J_o, inertia of tower and jib about the tower axis",
     .presence = fields::Presence::required_with_slew},
    {.key = "trolley_gain_mps2pv",
     .member = &Parameters::trolley_gain_mps2pv,
     .range = fields::Range::closed(1e-6, 1e3),
     .unit = "m/s² per V",
     .meaning = "K_mx, trolley acceleration per volt (4.4)",
     .presence = fields::Presence::required_with_trolley},
    {.key = "slew_gain_radps2pv",
     .member = &Parameters::slew_gain_radps2pv,
     .range = fields::Range::closed(1e-6, 1e3),
     .unit = "rad/s² per V",
     .meaning = "K_mγ, slew acceleration per volt at x = 0 (4.5)",
     .presence = fields::Presence::required_with_slew},
    {.key = "hoist_gain_mpspv",
     .member = &Parameters::hoist_gain_mpspv,
     .range = fields::Range::closed(1e-6, 1e3),
     .unit = "m/s per V",
     .meaning = "K_h, steady cable speed per volt",
     .presence = fields::Presence::required_with_hoist},
    {.key = "hoist_lag_s",
     .member = &Parameters::hoist_lag_s,
     .range = fields::Range::above(0, 10),
     .unit = "s",
     .meaning = "τ_h, time constant of the cable speed",
     .presence = fields::Presence::required_with_hoist},
}};

}  // namespace crane::plant
