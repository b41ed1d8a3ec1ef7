#pragma once
/// Forward sensitivities of a crane with smooth friction by SUNDIALS CVODES, the reference for slopes of the
/// fit: M. Caracotsios, W. E. Stewart, Comput. Chem. Eng. 9 (1985) 359,
///   s' = df/dy s + df/dp, s = dy/dp.
/// Command edges are stop times. Gain, offset and the poles of a lag of the command are exact in continuous
/// time; a delay shifts the edges, at each of which s jumps by f before - f after.
#include <functional>
#include <vector>

#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {

/// One parameter of a crane with smooth friction.
struct Varied {
  std::function<Crane(double)> crane;  ///< with the parameter at a value
  double value = 0;
  double step = 0;  ///< small change
};

/// By row: sensor values in the order of Output, and their derivative by the parameter.
using Reported = std::array<double, kOutputs>;
struct Sensitivity {
  std::vector<Reported> reported, slope;
  std::vector<plant::State> state;
};

/// The run from `start` under commands held for `period_s`. Part::drive prescribes the swing, Part::load the
/// drives: prescribed motion does not depend on the parameter.
/// @throws std::runtime_error when CVODES fails
[[nodiscard]] Sensitivity sensitivity(const Varied& varied, Part part,
                                      const std::vector<plant::PerAxis>& command_v, double period_s,
                                      const plant::State& start);

}  // namespace crane::diagnosis
