#pragma once
/// Sensors: the fault of the sensor, then noise, then quantisation.
#include <array>
#include <deque>

#include "chance.hpp"
#include "crane.hpp"

namespace mujoco_truth {

class Sensors {
 public:
  Sensors(const Physics& physics, double noise_counts, Chance& chance);
  /// Call after every step of the integration, and once at the start.
  void see(double time_s, const Pose& pose);
  struct Values {
    std::array<double, kAxes> position{};
    std::array<double, kSwings> swing{};
  };
  /// Present sensor values.
  Values measured();

 private:
  struct Past {
    double time_s;
    std::array<double, kSwings> swing, integral;
  };
  [[nodiscard]] Past past(double time_s) const;

  const Physics& physics_;
  double noise_counts_;
  Chance& chance_;
  std::deque<Past> history_;
  Pose pose_, first_;
  std::array<double, kAxes> way_{};
};

}  // namespace mujoco_truth
