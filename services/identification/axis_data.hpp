#pragma once
/// What a recorded run says about one drive: positions, and the volts that its motor and friction share.
#include "crane/configuration/rig.hpp"
#include "crane/identification/friction.hpp"
#include "crane/recording/csv.hpp"

namespace crane::identification {

/// "trolley", "slew", "hoist"
[[nodiscard]] const char* axis_name(std::size_t axis);
/// "m", "rad"
[[nodiscard]] const char* axis_unit(std::size_t axis);

/// Rows of a canonical table with time_s in [from_s, to_s]; volts less those that the load takes, (3.37),
/// (3.38) by the measured swing and the rig's masses.
/// @param axis  trolley or slew
/// @throws identification::IdentificationError  a column is missing, or the rows are not consecutive ticks
/// (without a
///   column tick: not one period apart)
[[nodiscard]] identification::AxisRun axis_run_from(const recording::Table& table,
                                                    const configuration::Rig& rig, std::size_t axis,
                                                    double from_s, double to_s);

/// 0 without a trolley.
[[nodiscard]] double mean_trolley_position(const recording::Table& table);

/// K_m that acts on the axis with the trolley at `trolley_position_m`: of the slew axis K_mgamma/(1 + M_r
/// x^2).
[[nodiscard]] double acting_gain(const control::Design& design, std::size_t axis, double trolley_position_m);

}  // namespace crane::identification
