#include "cli/inching.hpp"

#include <algorithm>
#include <cmath>

#include "crane/supervisor/modes.hpp"

namespace crane::cli {

double arc_rad(double step_m, double trolley_position_m) {
  return step_m / std::max(std::abs(trolley_position_m), supervisor::kShortestRadius_m);
}

AxisTargets inched(const std::array<double, 3>& reference, const InchingStep& step, double step_m) {
  constexpr std::size_t kSlew = 1;
  AxisTargets targets{.target = reference};
  targets.selected.at(step.axis) = true;
  targets.target[step.axis] += step.direction * (step.axis == kSlew ? arc_rad(step_m, reference[0]) : step_m);
  return targets;
}

AxisTargets back_to(const std::array<double, 3>& point, const std::array<double, 3>& now,
                    const std::array<bool, 3>& driven) {
  constexpr double kMoved = 1e-3;  // m, rad
  AxisTargets targets{.selected = driven, .target = point};
  for (std::size_t i = 0; i < point.size(); ++i)
    targets.selected[i] = driven[i] || std::abs(now[i] - point[i]) > kMoved;
  return targets;
}

}  // namespace crane::cli
