#pragma once
/// Candidates of the load: its mass, cable, forces and sensors.
#include <vector>

#include "crane/diagnosis/candidate.hpp"

namespace crane::diagnosis {

/// What the runs contain.
struct LoadData {
  bool trolley = false, slew = false;       ///< the motion of the support is measured
  bool driven = false;                      ///< the command of a drive is known
  bool radial = false, tangential = false;  ///< the swing angle is measured
};

/// Appends the candidates in the order of the report; none without a measured swing.
void add_load_candidates(const configuration::Rig& rig, const std::vector<PreparedRun>& runs,
                         const LoadData& data, std::vector<Candidate>& all);

}  // namespace crane::diagnosis
