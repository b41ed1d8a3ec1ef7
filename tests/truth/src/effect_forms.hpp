#pragma once
/// Form of each effect: changes of the crane, nominal sizes, and entries of the answer.
#include <array>
#include <string>

#include "random.hpp"
#include "truth/physics.hpp"
#include "truth/truth.hpp"

namespace truth {

/// One effect that is added to a crane. `size` is the amplitude with its sign.
struct Making {
  Physics& crane;
  std::size_t axis;  ///< 0 trolley or radial, 1 slew or tangential
  double size;
  Random& random;
  Found& found;

  [[nodiscard]] Drive& drive() const { return crane.drive[axis]; }
  /// Size times the nominal amplitude of the axis. Stores the value for the answer.
  double scaled(const std::string& name, std::array<double, 2> nominal, const std::string& unit) const {
    return say(name, size * nominal[axis], unit);
  }
  double say(const std::string& name, double value, const std::string& unit) const {
    found.parameters.push_back({name, value, unit});
    return value;
  }
};

// Effects on the drives and their encoders.
void coulomb_friction(const Making& m);
void viscous_friction(const Making& m);
void direction_asymmetry(const Making& m);
void stribeck_friction(const Making& m);
void position_dependent_friction(const Making& m);
void motor_gain(const Making& m);
void command_offset(const Making& m);
void command_dead_zone(const Making& m);
void command_delay(const Making& m);
void actuator_lag(const Making& m);
void torque_ripple(const Making& m);
void backlash(const Making& m);
void position_scale(const Making& m);
void position_drift(const Making& m);
void magnetic_detent(const Making& m);
void gain_drift(const Making& m);
void hysteretic_force(const Making& m);
void sticking_brake(const Making& m);
void periodic_force(const Making& m);
void crosstalk(const Making& m);

// Effects on the load, the jib and the swing sensors.
void payload_mass(const Making& m);
void cable_length(const Making& m);
void load_linear_drag(const Making& m);
void load_quadratic_drag(const Making& m);
void steady_wind(const Making& m);
void swing_pivot_friction(const Making& m);
void jib_tilt(const Making& m);
void jib_flexibility(const Making& m);
void cable_elasticity(const Making& m);
void double_pendulum(const Making& m);
void swing_offset(const Making& m);
void swing_misalignment(const Making& m);
void swing_scale(const Making& m);
void swing_delay(const Making& m);
void swing_moving_average(const Making& m);
void load_periodic_force(const Making& m);

}  // namespace truth
