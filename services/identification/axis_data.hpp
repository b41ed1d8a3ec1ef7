#pragma once
/// Extracts the data of one drive from a recorded run: positions, and voltages without the force of the load.
#include "crane/configuration/rig.hpp"
#include "crane/identification/friction.hpp"
#include "crane/recording/csv.hpp"

namespace crane::identification {

/// Extracts the rows with time_s in [from_s, to_s] of a canonical table. Subtracts from the voltages the
/// compensation of the load force, second parts of (3.37), (3.38) of H. M. Omar, Control of Gantry and Tower
/// Cranes, computed from the measured swing and the masses of the rig.
/// @param axis  trolley or slew
/// @throws identification::IdentificationError when a column is missing, or the rows are not consecutive
///   ticks (without a column tick: not one period apart)
[[nodiscard]] identification::AxisRun axis_run_from(const recording::Table& table,
                                                    const configuration::Rig& rig, std::size_t axis,
                                                    double from_s, double to_s);

/// Mean trolley position, m; 0 without a trolley.
[[nodiscard]] double mean_trolley_position(const recording::Table& table);

/// K_m of the axis with the trolley at `trolley_position_m`; for the slew axis K_mgamma/(1 + M_r x^2).
[[nodiscard]] double acting_gain(const control::Design& design, std::size_t axis, double trolley_position_m);

}  // namespace crane::identification
