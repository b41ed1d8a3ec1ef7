#pragma once
/// Values that no motion explains: spikes and frozen columns. They are left out and named with row and time.
#include "data/columns.hpp"

namespace crane::diagnosis {

/// Multiple of the sensor error by which a spike or a reset exceeds the credible motion: probability 1e-23
/// per row with normal noise.
inline constexpr double kBeyondSensor = 10;

/// Largest credible change of an output in a time, m or rad: of a drive at five times its largest speed, of a
/// swing at three times the speed of a fall from upright.
[[nodiscard]] double largest_credible_change(const configuration::Rig& rig, Output output, double time_s);
/// Largest motion of a drive within the time from rest, a t^2 / 2: each of three forces accelerates at most
/// as much as the largest voltage. 0 for a swing. m or rad
[[nodiscard]] double largest_change_from_rest(const configuration::Rig& rig, Output output, double time_s);

/// Sets spikes and frozen values of the rig's outputs to NaN. A column with too many spikes is a problem.
/// @pre the times increase
void omit_spikes_and_frozen(recording::Table& table, const configuration::Rig& rig, Findings& findings);

}  // namespace crane::diagnosis
