#pragma once
/// Swing columns that stand for each other, or have the other sign: what the support does excites the swing
/// along it.
#include "data/columns.hpp"

namespace crane::diagnosis {

/// Correlates r'' + (g / l) r of each swing with the acceleration of the trolley, and of the slew with the
/// opposite sign; a swing that follows the other axis, or its own with the other sign, is a problem.
void find_swapped(const std::vector<Run>& runs, const configuration::Rig& rig, Findings& findings);

}  // namespace crane::diagnosis
