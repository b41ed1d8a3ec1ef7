#pragma once
/// References and four controllers. The controllers use only the sensor values.
#include <array>
#include <cmath>

#include "run.hpp"

namespace mujoco_truth {

class Driver {
 public:
  Driver(const Rig& rig, const Nuisance& nuisance, const RunPlan& plan);
  /// Voltages from this row on.
  std::array<double, kAxes> command(const Row& row);

 private:
  struct Tone {
    double amplitude, hz, phase;
  };
  struct Plan {
    double centre = 0, reach = 0, speed = 0;
    std::vector<std::array<double, 3>> targets;  ///< start time, duration, target
    std::vector<Tone> tones;
    std::vector<std::array<double, 3>> presses;  ///< start time, end time, voltage
  };
  void plan_axis(std::size_t axis, Chance& chance);
  [[nodiscard]] std::array<double, 2> reference(const Plan& plan, double time_s) const;
  double follow(std::size_t axis, const Row& row, double position_speed, double swing_rate);

  const Rig& rig_;
  const Nuisance& nuisance_;
  RunPlan run_;
  std::array<Plan, kAxes> plan_;
  std::array<double, kAxes> last_position_{}, speed_{};
  std::array<double, kSwings> last_swing_{}, rate_{};
  double last_s_ = -1;
};

}  // namespace mujoco_truth
