#pragma once
/// Integrates the equations of motion of a crane in fixed leapfrog steps (drift-kick-drift, second order).
/// Some outputs are simulated; the others are prescribed, which means set to measured kinematics.
#include <array>

#include "crane/plant/model.hpp"
#include "crane/stepper/kinematics.hpp"

namespace crane::stepper {

/// Number of steps in a period. A step is at most 5 ms long, or 2.5 ms with inner coordinates, which may
/// oscillate at 25 Hz.
[[nodiscard]] int steps_in(double period_s, bool inner_coordinates);

class StepIntegrator {
 public:
  /// @param model outlives the integrator
  StepIntegrator(const plant::Model& model, const std::array<bool, kOutputs>& simulated,
                 const plant::Locks& locks, double step_s);

  plant::State state;
  plant::InnerState inner{};
  /// Prescribed inner coordinates, and their kinematics in the middle of the next step.
  std::array<bool, plant::kMostInner> prescribed{};
  std::array<Kinematics, plant::kMostInner> prescribed_at{};

  /// @param drive_v  output of the amplifiers from the next step on [V]
  void new_command(const plant::PerAxis& drive_v);
  /// Advances the simulated outputs by one step. prescribe() sets the other outputs.
  /// @param at  measured kinematics in the middle of the step
  void step(const MeasuredKinematics& at);
  /// @return accelerations of the model in the middle of the next step: the simulated outputs are
  ///   extrapolated by half a step, the other outputs have the kinematics `at`, the inner coordinates their
  ///   present state
  [[nodiscard]] plant::Accelerations accelerations(const MeasuredKinematics& at);
  /// Sets the outputs that are not simulated, and the cable, to measured kinematics.
  void prescribe(const MeasuredKinematics& at);

 private:
  [[nodiscard]] plant::State mid_step(const MeasuredKinematics& at);
  void kick(Output output, double acceleration);
  /// Replaces the extrapolated state of prescribed inner coordinates.
  void prescribe_inner(plant::InnerState& inner, plant::InnerAccelerations& accelerations) const;
  void kick_inner(const plant::InnerAccelerations& accelerations);
  /// Advances the drives by one step. Friction acts implicitly, axis by axis, with the last friction of the
  /// other axis. @return mean friction, V
  plant::PerAxis move_drives(const plant::State& middle, const plant::InnerState& inner_middle,
                             const plant::ModelEquations& without_friction);

  const plant::Model& model_;
  std::array<bool, kOutputs> simulated_;
  double h_;  ///< step, s
  plant::Actuation actuation_;
  std::array<double, kOutputs> last_{};
  std::array<double, plant::kMostInner> last_inner_{};
  plant::PerAxis last_friction_{};
  std::array<plant::PerAxis, plant::kAxes> gain_{};  ///< acceleration per volt of friction
  bool gains_known_ = false;
};

}  // namespace crane::stepper
