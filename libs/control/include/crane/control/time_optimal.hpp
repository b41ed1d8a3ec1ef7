#pragma once
/// Time-optimal moves of trolley and slew with a swinging load, from rest to rest without residual swing.
///
/// Direct multiple shooting with N intervals of equal length T/N and constant volts. The model has the
/// nonlinear equations of the tower with centrifugal coupling (plant/equations.hpp) and friction; each
/// interval is one Runge-Kutta step with exact first derivatives. The objective is T plus a small
/// effort, so that a drive that does not limit T has no unnecessary voltage. The limits on volts,
/// swing, speed and position hold at the ends of the intervals. Solver: primal-dual interior point
/// method. A Riccati recursion over the intervals solves the Newton step, so that the computation
/// time is proportional to N. The result does not depend on a clock: equal problems have equal
/// plans.
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
  double swing_rad = 0.17453292519943295;                 ///< largest |phi| and |theta|
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
  not_converged,  ///< too many iterations, or no step improved the iterate
  impossible      ///< problems() states the reason
};

struct PlanResult {
  PlanOutcome outcome = PlanOutcome::not_converged;
  int iterations = 0;
  Plan plan;  ///< valid with PlanOutcome::solved
};

/// @return all problems as "name = value: rule"; empty when the move is possible
[[nodiscard]] std::vector<std::string> problems(const PlanProblem& problem);

/// Allocates no memory and reads no clock. @pre problems(design).empty()
/// @param warm  plan of a similar move; nullptr: none
[[nodiscard]] PlanResult time_optimal_plan(const Design& design, const PlanProblem& problem,
                                           const Plan* warm = nullptr) noexcept;

/// The plan at `time_s` after its start: positions, speeds, accelerations, swing, and volts without the
/// compensated friction. Before 0 and after the duration the reference is at rest.
[[nodiscard]] Reference reference_at(const Design& design, const PlanProblem& problem, const Plan& plan,
                                     double time_s) noexcept;

}  // namespace crane::control
