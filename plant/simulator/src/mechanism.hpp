#pragma once
/// Mechanical model of the rig: equations of motion with brakes and end stops.
#include <limits>

#include "crane/simulator/integrator.hpp"
#include "crane/simulator/simulated_rig.hpp"

namespace crane::simulator {

class Mechanism {
 public:
  /// @throws std::invalid_argument with all problems of the rig
  Mechanism(const SimulatedRig& rig, const Tolerances& tolerances);

  [[nodiscard]] const plant::State& state() const noexcept { return state_; }
  /// Begins a tick with the given voltages of the board [V].
  void begin_tick(const plant::PerAxis& board_v) noexcept;
  /// Output of the sensors. Call once per tick.
  [[nodiscard]] plant::Measurement measure() noexcept { return model_.measure(state_); }
  void set_brake(plant::Axis axis, bool closed) noexcept { brake_closed_[axis] = closed; }
  void kick(double radial_radps, double tangential_radps) noexcept;

  /// Integrates with constant command and brakes. @throws std::runtime_error when the integration fails
  void run(double seconds);

 private:
  struct Situation {
    plant::Actuation actuation;
    Watch watch;
  };
  [[nodiscard]] Situation situation();
  void brake(plant::Axis axis, Situation& now);
  void meet_stop(plant::Axis axis, Situation& now);
  void stop(plant::Axis axis, const plant::Locks& locks);
  [[nodiscard]] double brake_effort(plant::Axis axis) const;

  std::array<SimulatedDrive, plant::kAxes> drives_;
  plant::Model model_;
  Integrator integrator_;
  plant::State state_;
  plant::InnerState inner_{};
  plant::Locks absent_;
  std::array<bool, plant::kAxes> brake_closed_{true, true, true};
  plant::PerAxis drive_v_{};
  double first_step_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace crane::simulator
