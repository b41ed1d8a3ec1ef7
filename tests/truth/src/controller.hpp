#pragma once
/// Position loop at 100 Hz with feed-forward, approximate friction compensation, and light damping of the
/// swing.
#include "motion.hpp"

namespace truth {

class Controller {
 public:
  Controller(const Physics& nominal, const Plan& plan);
  /// @return the command of the next tick, computed from the present sensor values
  Volts step(const Sensed& measured, double time_s);

 private:
  struct Ramp {
    double since_s = 0.5, direction = 1, held_at = 0;
    bool holding = false;
  };
  [[nodiscard]] double track(std::size_t axis, const Target& target, const Sensed& measured) const;
  double ramp(std::size_t axis, const Sensed& measured, double time_s);
  [[nodiscard]] double gain(std::size_t axis, const Sensed& measured) const;

  Physics nominal_;
  Plan plan_;
  Sensed last_{}, rate_{};
  bool first_ = true;
  std::array<Ramp, kDrives> ramps_;
};

}  // namespace truth
