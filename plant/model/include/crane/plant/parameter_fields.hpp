#pragma once
/// Section [plant] of a rig file, and the ranges that more than one section uses. No crane of this project is
/// outside them, and inside them every quotient of the equations is finite.
#include "crane/fields/field.hpp"
#include "crane/plant/parameters.hpp"

namespace crane::plant {

/// The equations divide by cos(swing): 1.5 rad keeps it above 0.07.
inline constexpr fields::Range kSwings = fields::Range::closed(-1.5, 1.5);
/// m or rad; a tower crane's jib is below 100 m.
inline constexpr fields::Range kPositions = fields::Range::closed(-1000, 1000);
/// The equations divide by the length.
inline constexpr fields::Range kCableLengths = fields::Range::closed(1e-3, 1000);
/// Ticks from 10 Hz, a few samples in a period of the load, to 100 kHz.
inline constexpr fields::Range kPeriods = fields::Range::closed(1e-5, 0.1);

// Masses reach to a thousand tonnes, beyond the load of any tower crane. What equations divide by is at least
// 1e-6.
inline constexpr std::array<fields::Field<Parameters>, 9> kParameterFields{{
    {.key = "gravity_mps2",
     .member = &Parameters::gravity_mps2,
     .range = fields::Range::closed(1e-3, 100),
     .unit = "m/s²",
     .meaning = "g"},
    {.key = "trolley_inertia_kg",
     .member = &Parameters::trolley_inertia_kg,
     .range = fields::Range::closed(1e-6, 1e6),
     .unit = "kg",
     .meaning = "M, felt by the trolley drive (4.3)",
     .presence = fields::Presence::required_with_trolley},
    {.key = "trolley_mass_kg",
     .member = &Parameters::trolley_mass_kg,
     .range = fields::Range::closed(0, 1e6),
     .unit = "kg",
     .meaning = "M_j, in rotational and centrifugal terms",
     .presence = fields::Presence::required_with_trolley},
    {.key = "load_mass_kg",
     .member = &Parameters::load_mass_kg,
     .range = fields::Range::closed(0, 1e6),
     .unit = "kg",
     .meaning = "m; 0 for a drive_axis",
     .presence = fields::Presence::required_with_load},
    {.key = "jib_inertia_kgm2",
     .member = &Parameters::jib_inertia_kgm2,
     .range = fields::Range::closed(1e-6, 1e8),
     .unit = "kg m²",
     .meaning = "J_o",
     .presence = fields::Presence::required_with_slew},
    {.key = "trolley_gain_mps2pv",
     .member = &Parameters::trolley_gain_mps2pv,
     .range = fields::Range::closed(1e-6, 1e3),
     .unit = "m/s² per V",
     .meaning = "K_mx (4.4)",
     .presence = fields::Presence::required_with_trolley},
    {.key = "slew_gain_radps2pv",
     .member = &Parameters::slew_gain_radps2pv,
     .range = fields::Range::closed(1e-6, 1e3),
     .unit = "rad/s² per V",
     .meaning = "K_mγ at x = 0 (4.5)",
     .presence = fields::Presence::required_with_slew},
    {.key = "hoist_gain_mpspv",
     .member = &Parameters::hoist_gain_mpspv,
     .range = fields::Range::closed(1e-6, 1e3),
     .unit = "m/s per V",
     .meaning = "steady cable speed per volt",
     .presence = fields::Presence::required_with_hoist},
    {.key = "hoist_lag_s",
     .member = &Parameters::hoist_lag_s,
     .range = fields::Range::above(0, 10),
     .unit = "s",
     .meaning = "time constant of the hoist drive",
     .presence = fields::Presence::required_with_hoist},
}};

}  // namespace crane::plant
