#pragma once
/// One window under way: a crane in fixed steps, some coordinates simulated, the others going where they were
/// measured.
#include <array>

#include "crane/diagnosis/kinematics.hpp"
#include "crane/plant/model.hpp"

namespace crane::diagnosis {

/// Equal steps in a period: a coordinate of a term's own may ring at 25 Hz.
[[nodiscard]] int steps_in(double period_s, bool inner_coordinates);

class StepIntegrator {
 public:
  /// @param model outlives the integrator
  StepIntegrator(const plant::Model& model, const std::array<bool, kOutputs>& simulated,
                 const plant::Locks& locks, double step_s);

  plant::State state;
  plant::InnerState inner{};
  /// Terms' own coordinates that go as prescribed_motion, and where they are in the middle of the next step.
  std::array<bool, plant::kMostInner> prescribed{};
  std::array<Kinematics, plant::kMostInner> prescribed_at{};

  void new_command(const plant::PerAxis& drive_v);
  /// @param at what is measured in the middle of the step. What is not simulated stays where it is in
  /// `state`, until it is evaluated to prescribe
  void step(const MeasuredKinematics& at);
  /// As the model has them where everything is measured.
  [[nodiscard]] plant::Accelerations accelerations(const MeasuredKinematics& at);
  /// Coordinates that are not simulated go where they were measured.
  void prescribe(const MeasuredKinematics& at);

 private:
  [[nodiscard]] plant::State mid_step(const MeasuredKinematics& at);
  void kick(Output output, double acceleration);
  /// What goes as prescribed_motion, put in the place of what was extrapolated.
  void prescribe_inner(plant::InnerState& inner, plant::InnerAccelerations& accelerations) const;
  void kick_inner(const plant::InnerAccelerations& accelerations);
  /// Friction of each axis, solved one after the other with the other's last value.
  plant::PerAxis move_drives(const plant::State& middle, const plant::InnerState& inner_middle);

  const plant::Model& model_;
  std::array<bool, kOutputs> simulated_;
  double h_;
  plant::Actuation actuation_;
  std::array<double, kOutputs> last_{};
  std::array<double, plant::kMostInner> last_inner_{};
  plant::PerAxis last_friction_{};
  std::array<plant::PerAxis, plant::kAxes> gain_{};  ///< accelerations a volt of friction takes
  bool gains_known_ = false;
};

}  // namespace crane::diagnosis
