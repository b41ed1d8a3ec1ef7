#pragma once
/// State of a Replay: commands by step, measured motion with inverted sensor terms, inner coordinates along
/// that motion.
#include <mutex>
#include <optional>

#include "crane/diagnosis/replay.hpp"
#include "crane/stepper/step_integrator.hpp"

namespace crane::diagnosis {

using stepper::StepIntegrator, stepper::steps_in;

/// Stochastic approximation of the median of the last few hundred values.
class RunningMedian {
 public:
  void take(double value) { median_ *= value > median_ ? 1 + kShare : 1 - kShare; }
  [[nodiscard]] double value() const { return median_; }

 private:
  static constexpr double kShare = 0.02;
  double median_ = 0.02;  // m/s or rad/s, more than noise
};

struct Replay::CraneOnRun {
  CraneOnRun(const PreparedRun& prepared, const Crane& the_crane);

  /// Locks of all coordinates that are not simulated.
  [[nodiscard]] plant::Locks locks(const std::array<bool, kOutputs>& simulated) const;
  [[nodiscard]] double step_s() const { return source.run.period_s / steps; }
  /// Calls visit(step, voltage, voltage has changed) for each step from a row to the next.
  template <class Visit>
  void visit_steps(std::size_t row, Visit&& visit) const {
    const auto first = row * static_cast<std::size_t>(steps);
    for (int step = 0; step < steps; ++step) {
      const auto at = first + static_cast<std::size_t>(step);
      visit(step, drive_v[at], step == 0 || drive_v[at] != drive_v[at - 1]);
    }
  }
  /// Measured kinematics at a row, sensor terms inverted.
  [[nodiscard]] MeasuredKinematics measured_at(std::size_t row) const;
  /// Midway between a row and the next.
  [[nodiscard]] MeasuredKinematics measured_mid_row(std::size_t row) const;
  [[nodiscard]] const MeasuredKinematics& mid_step(std::size_t row, int step) const {
    const auto& all = sensors ? corrected_mid_step : source.mid_step[model.inner_coordinates() > 0 ? 1 : 0];
    return all[row * static_cast<std::size_t>(steps) + static_cast<std::size_t>(step)];
  }
  /// Sets the increments of the measured drives that simulate_inner_coordinates() has not set.
  void compute_increments();
  /// Fills the memory of the sensors with the motion before a row.
  void warm_up_sensors(plant::Model& sensing, std::size_t row) const;
  [[nodiscard]] const Motion& prescribed_motion(Output output) const {
    return sensors ? corrected[output] : source.motion[output];
  }

  const PreparedRun& source;
  Crane crane;
  int steps;                   ///< from a row to the next
  mutable plant::Model model;  // its memory is used by the constructor only
  bool sensors;
  std::vector<std::size_t> ringing;  ///< inner coordinates that oscillate freely: part of the start
  std::array<bool, plant::kMostInner> prescribed{};  ///< the other ones
  std::vector<plant::PerAxis> drive_v;               ///< by step
  std::array<Motion, kOutputs> corrected;
  std::vector<MeasuredKinematics> corrected_mid_step;
  std::vector<plant::InnerState> inner_at;      ///< along the measured motion, by row; empty without any
  std::array<Motion, plant::kMostInner> inner;  ///< of prescribed inner coordinates
  std::array<std::optional<Increments>, 2> increments;  ///< of the drives along the measured motion
  std::once_flag increments_known;

 private:
  [[nodiscard]] Increments empty_increments(Output axis) const;
  void invert_sensors();
  void simulate_inner_coordinates();
  [[nodiscard]] plant::PerAxis impacts_after(std::size_t row, std::array<RunningMedian, 2>& usual) const;
};

}  // namespace crane::diagnosis
