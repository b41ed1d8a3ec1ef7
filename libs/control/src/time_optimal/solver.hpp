#pragma once
/// Interior point method of the time-optimal plan (time_optimal.hpp). An iterate has T, the volts of every
/// interval, and the states at the ends of the intervals. The gap between the end of one interval and the
/// start of the next closes as the iterations converge (multiple shooting). A Newton step solves, with the
/// changes ds, du, dT and the curvature Sigma of the barriers,
///   minimise sum of barriers + T + effort,  ds(k+1) = A ds(k) + B du(k) + d dT + gap(k),  end state reached
/// by a Riccati recursion over (ds, dT). It omits the curvature of the equations: time-optimal volts are at
/// their limits, so that the solution of the linearised problem is at a corner.
#include "tower.hpp"

namespace crane::control::time_optimal {

struct Bounded {
  double low_dual = 0, high_dual = 0;  ///< multipliers of both bounds
};

class Solver {
 public:
  Solver(const Design& design, const PlanProblem& problem) noexcept;
  [[nodiscard]] PlanResult solve(const Plan* warm) noexcept;

 private:
  static constexpr int kIntervals = kPlanIntervals;
  static constexpr int kAugmented = kStates + 1;  // ds and dT
  using Augmented = Eigen::Matrix<double, kAugmented, kAugmented>;
  using AugmentedVector = Eigen::Matrix<double, kAugmented, 1>;

  struct Iterate {
    double duration_s = 0;
    std::array<State, kIntervals + 1> state;
    std::array<Control, kIntervals> volts;
  };
  /// Quality of an iterate.
  struct Merit {
    double gaps = 0;     ///< sum of the absolute gaps
    double barrier = 0;  ///< objective with the barriers
  };

  void guess(const Plan* warm) noexcept;
  void centre_duals() noexcept;
  /// Moves towards the shortest duration. @return false when the iterations have failed
  [[nodiscard]] bool search(int& iterations) noexcept;
  void fix_duration(double factor) noexcept;
  [[nodiscard]] bool close_gaps(int& iterations) noexcept;
  void linearise() noexcept;
  [[nodiscard]] Merit merit(const Iterate& at) const noexcept;
  void find_step() noexcept;
  [[nodiscard]] double longest_step() const noexcept;
  [[nodiscard]] bool take_step() noexcept;
  void update_duals(double share) noexcept;

  Tower tower_;
  State from_, to_, low_, high_;
  Control volt_limit_;
  double barrier_ = 0;  ///< mu
  bool fixed_ = false;  ///< true: the duration is fixed, the iterations close the gaps
  double share_ = 1;    ///< executed share of the last step
  Iterate at_, change_, trial_;
  std::array<Step, kIntervals> steps_;
  std::array<State, kIntervals> gaps_;
  std::array<std::array<Bounded, kStates>, kIntervals + 1> state_duals_;
  std::array<std::array<Bounded, kControls>, kIntervals> volt_duals_;
  std::array<Eigen::Matrix<double, kControls, kAugmented>, kIntervals> feedback_;
  std::array<Control, kIntervals> feed_forward_;
  State end_dual_ = State::Zero();
};

}  // namespace crane::control::time_optimal
