#pragma once
/// Values that no motion makes: spikes, columns that freeze. They are left out, each named with row and time.
#include "data/columns.hpp"

namespace crane::diagnosis {

/// Largest change of an output in a time that is believed, m or rad: of a drive five times its largest speed,
/// of a swing three times the speed of a fall from upright.
[[nodiscard]] double largest_credible_change(const configuration::Rig& rig, Output output, double time_s);

/// Makes broken values of the rig's outputs NaN. A column with too many of them is a problem.
/// @pre the times increase
void leave_broken_out(recording::Table& table, const configuration::Rig& rig, Findings& findings);

}  // namespace crane::diagnosis
