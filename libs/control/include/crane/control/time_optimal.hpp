#pragma once
/// Time-optimal moves of trolley and slew with a swinging load, from rest to rest without residual swing.
///
/// Direct multiple shooting: N intervals of equal length T/N with constant volts; the nonlinear equations of
/// the tower with its centrifugal coupling (plant/equations.hpp) and friction, one Runge-Kutta step per
/// interval, exact first derivatives. Minimised: T plus a small effort, so that volts without influence on T
/// are zero. Limits on volts, swing, speed and position hold at the ends of the intervals.
/// Solver: primal-dual interior point; a Riccati recursion over the intervals solves the Newton step, so that
/// the effort grows with N and not with its cube. No dependence on a clock: equal problems have equal plans.
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "crane/control/law.hpp"

namespace crane::control {

inline constexpr int kPlanIntervals = 40;
inline constexpr int kPlanStates = 8;
/// x, phi, gamma, theta and their rates; signs of Measurement.
using PlanState = Eigen::Matrix<double, kPlanStates, 1>;
using PlanVolts = Eigen::Vector2d;  ///< trolley, slew: output of the amplifiers, friction included

/// Trolley 0, slew 1.
struct PlanLimits {
  std::array<double, 2> volts{10, 10};
  std::array<double, 2> low{-1e3, -1e3}, high{1e3, 1e3};  ///< m, rad
  std::array<double, 2> speed{1e3, 1e3};                  ///< m/s, rad/s
  double swing_rad = 0.17453292519943295;                 ///< of either angle
};

struct PlanProblem {
  std::array<double, 2> from{}, to{};  ///< positions of trolley and slew
  double cable_m = 1;
  PlanLimits limits;
};

struct Plan {
  double duration_s = 0;
  std::array<PlanState, kPlanIntervals + 1> state;
  std::array<PlanVolts, kPlanIntervals> volts;
};

enum class PlanOutcome : std::uint8_t {
  solved,
  not_converged,  ///< the iterations were used up, or no step made progress
  impossible      ///< problems() says why
};

struct PlanResult {
  PlanOutcome outcome = PlanOutcome::not_converged;
  int iterations = 0;
  Plan plan;  ///< valid with PlanOutcome::solved
};

/// @return all problems as "name = value: rule"; empty when the move is possible
[[nodiscard]] std::vector<std::string> problems(const PlanProblem& problem);

/// No allocation, no clock. @pre problems(design).empty()
/// @param warm  plan of a similar move; nullptr: none
[[nodiscard]] PlanResult time_optimal_plan(const Design& design, const PlanProblem& problem,
                                           const Plan* warm = nullptr) noexcept;

/// The plan at `time_s` after its start: positions with speeds and accelerations, swing, and the volts
/// without the friction that is compensated. At rest at its ends outside [0, duration].
[[nodiscard]] Reference reference_at(const Design& design, const PlanProblem& problem, const Plan& plan,
                                     double time_s) noexcept;

}  // namespace crane::control
