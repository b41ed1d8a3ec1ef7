/// Checks of a plan's problem, and the reference of a plan.
#include <algorithm>
#include <cmath>

#include "crane/fields/range.hpp"
#include "crane/plant/coordinates.hpp"
#include "tower.hpp"

namespace crane::control {
namespace {

/// State of the plan, at rest before its start and after its end.
PlanState plan_state_at(const time_optimal::Tower& tower, const Plan& plan, double time_s) noexcept {
  const double share = time_s / plan.duration_s * kPlanIntervals;
  if (!(share > 0)) return plan.state.front();
  if (share >= kPlanIntervals) return plan.state.back();
  const auto k = static_cast<std::size_t>(share);
  const double since_s = time_s - static_cast<double>(k) * plan.duration_s / kPlanIntervals;
  time_optimal::Step at;
  step(tower, plan.state[k], plan.volts[k], since_s, false, at);
  return at.next;
}

/// Mean of the planned volts over [begin_s, begin_s + width_s]; 0 outside the plan.
PlanVolts mean_volts(const Plan& plan, double begin_s, double width_s) noexcept {
  const double interval_s = plan.duration_s / kPlanIntervals;
  PlanVolts sum = PlanVolts::Zero();
  const auto first = static_cast<int>(std::floor(begin_s / interval_s));
  const auto last = static_cast<int>(std::floor((begin_s + width_s) / interval_s));
  for (int k = std::max(first, 0); k <= std::min(last, kPlanIntervals - 1); ++k) {
    const double from_s = std::max(begin_s, k * interval_s);
    const double to_s = std::min(begin_s + width_s, (k + 1) * interval_s);
    sum += std::max(0.0, to_s - from_s) * plan.volts[static_cast<std::size_t>(k)];
  }
  return sum / width_s;
}

}  // namespace

std::vector<std::string> problems(const PlanProblem& problem) {
  std::vector<std::string> found;
  const auto require = [&](bool holds, const std::string& name, double value, const char* rule) {
    if (!holds) found.push_back(fields::complaint(name, value, rule));
  };
  const PlanLimits& l = problem.limits;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string axis = plant::kCoordinates[i].name;
    require(l.low[i] < l.high[i], axis + " low", l.low[i],
            "must be below the high limit: widen the limits of the drive");
    require(problem.from[i] > l.low[i] && problem.from[i] < l.high[i], axis + " start", problem.from[i],
            "must be inside the limits: move the axis between them first");
    require(problem.to[i] > l.low[i] && problem.to[i] < l.high[i], axis + " target", problem.to[i],
            "must be inside the limits: choose a target between them");
    require(l.volts[i] > 0 && l.volts[i] <= 1e3, axis + " volts", l.volts[i], "must be in (0, 1000]");
    require(l.speed[i] > 0 && l.speed[i] <= 1e3, axis + " speed", l.speed[i], "must be in (0, 1000]");
  }
  require(l.swing_rad > 0 && l.swing_rad < 1.5, "swing", l.swing_rad, "must be in (0, 1.5)");
  require(problem.cable_m >= 1e-3 && problem.cable_m <= 1e3, "cable", problem.cable_m,
          "must be in [0.001, 1000]");
  return found;
}

Reference reference_at(const Design& design, const PlanProblem& problem, const Plan& plan,
                       double time_s) noexcept {
  const time_optimal::Tower tower{design, problem.cable_m};
  const double period_s = design.period_s;
  Reference reference;
  reference[kHoist].position = problem.cable_m;
  if (time_s >= plan.duration_s) {  // exactly the target
    reference[kTrolley].position = problem.to[kTrolley];
    reference[kSlew].position = problem.to[kSlew];
    return reference;
  }
  const PlanState now = plan_state_at(tower, plan, time_s);
  time_optimal::Flow flow;
  time_optimal::flow(tower, now, mean_volts(plan, time_s, period_s), false, flow);
  reference[kTrolley] = {now[0], now[4], flow.rate[4]};
  reference[kSlew] = {now[2], now[6], flow.rate[6]};
  const PlanState ahead = plan_state_at(tower, plan, time_s + period_s);
  reference.swing = {ahead[1], ahead[5], ahead[3], ahead[7]};
  const PlanState middle = plan_state_at(tower, plan, time_s + 1.5 * period_s);
  const PlanVolts volts = mean_volts(plan, time_s + period_s, period_s);
  if (time_s + period_s < plan.duration_s) {
    reference.feed_forward_v[kTrolley] =
        volts[0] - time_optimal::smooth_friction(design.friction[kTrolley], middle[4]).volts;
    reference.feed_forward_v[kSlew] =
        volts[1] - time_optimal::smooth_friction(design.friction[kSlew], middle[6]).volts;
  }
  return reference;
}

}  // namespace crane::control
