#pragma once
/// Candidates that act on the load: its mass, its cable, forces on it, and the sensors of the swing.
#include <vector>

#include "study/candidate_shapes.hpp"

namespace crane::diagnosis {

/// Signals that the runs contain.
struct LoadData {
  bool trolley = false, slew = false;       ///< the motion of the support is measured
  bool driven = false;                      ///< the command of a drive is known
  bool radial = false, tangential = false;  ///< the swing angle is measured
};

/// Appends the candidates of the load to `all`, in the order of the report; none without a measured swing.
void add_load_candidates(const configuration::Rig& rig, const std::vector<PreparedRun>& runs,
                         const LoadData& data, CandidateList& all);

}  // namespace crane::diagnosis
