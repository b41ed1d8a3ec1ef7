#pragma once
/// Swing columns that are swapped or have the wrong sign.
#include "data/columns.hpp"

namespace crane::diagnosis {

/// Correlates r'' + (g / l) r of each swing with the trolley's acceleration. A tangential swing that follows
/// the trolley, or a radial one that follows it with the opposite sign, is a problem.
void find_swapped(const std::vector<Run>& runs, const configuration::Rig& rig, Findings& findings);

}  // namespace crane::diagnosis
