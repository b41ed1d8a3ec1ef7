#pragma once
/// Forward sensitivities of the smooth crane by SUNDIALS CVODES, the yardstick for what the fit takes from
/// fixed-step replays: M. Caracotsios, W. E. Stewart, Comput. Chem. Eng. 9 (1985) 359,
///   s' = df/dy s + df/dp, s = dy/dp.
/// Command edges are stop times. Gain, offset and the poles of a lag of the command are exact in continuous
/// time; a delay shifts the edges, at each of which s jumps by f before - f after.
#include <functional>
#include <vector>

#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {

/// One parameter of a crane whose friction is smooth.
struct Varied {
  std::function<Crane(double)> crane;  ///< with the parameter at a value
  double value = 0;
  double step = 0;  ///< a change that is small
};

/// By row: what the sensors report, in the order of Output, and its derivative by the parameter.
using Reported = std::array<double, kOutputs>;
struct Sensitivity {
  std::vector<Reported> reported, slope;
  std::vector<plant::State> state;
};

/// The run from `start` under commands held for `period_s`. With Part::drive the swing is given, it does not
/// feel the parameter; with Part::load the motion of the drives.
/// @throws std::runtime_error when CVODES cannot go on
[[nodiscard]] Sensitivity sensitivity(const Varied& varied, Part part,
                                      const std::vector<plant::PerAxis>& command_v, double period_s,
                                      const plant::State& start);

}  // namespace crane::diagnosis
