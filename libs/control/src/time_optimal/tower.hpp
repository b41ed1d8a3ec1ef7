#pragma once
/// The equations of motion of the tower at constant cable length, with exact first derivatives. The
/// terms are those of the plant (plant/motion_terms.hpp).
#include <Eigen/Core>

#include "crane/control/time_optimal.hpp"

namespace crane::control::time_optimal {

constexpr int kStates = kPlanStates;
constexpr int kControls = 2;
using State = PlanState;
using Control = PlanVolts;
using StateMatrix = Eigen::Matrix<double, kStates, kStates>;
using ControlMatrix = Eigen::Matrix<double, kStates, kControls>;

struct Tower {
  const Design& design;
  double cable_m;
};

/// Friction of a drive in volts, smoothed around standstill so that it has a derivative.
struct Friction {
  double volts, slope;
};
[[nodiscard]] Friction smooth_friction(const DriveFriction& friction, double speed) noexcept;

struct Flow {
  State rate;            ///< d state / dt
  StateMatrix by_state;  ///< its derivatives
  ControlMatrix by_control;
};
/// @param derivatives  false: only `rate` is computed
void flow(const Tower& tower, const State& state, const Control& volts, bool derivatives,
          Flow& result) noexcept;

/// State after `step_s` with constant volts: one Runge-Kutta step of order 4.
struct Step {
  State next;
  StateMatrix by_state;
  ControlMatrix by_control;
  State by_duration;
};
void step(const Tower& tower, const State& state, const Control& volts, double step_s, bool derivatives,
          Step& result) noexcept;

}  // namespace crane::control::time_optimal
