#pragma once
/// The part of an axis on the load side of a backlash or a spring ("far side"), and its forces on the motor
/// side.
#include "crane/plant/equations.hpp"
#include "crane/plant/motion_terms.hpp"
#include "crane/plant/parameters.hpp"

namespace crane::plant {

/// The far side has the share j of the axis's inertia J and carries trolley and load (jib) or the load
/// (trolley). The force of the load is that of the static cable tension; its error increases with the square
/// of the swing. With j = 0 the far side is only the suspension point, without inertia; the motor then
/// accelerates everything.
class FarSide {
 public:
  FarSide(bool slew, double share) : slew_(slew), share_(share) {}

  [[nodiscard]] bool carries() const { return share_ > 0; }
  /// Removes the inertia of the far side from the parameters of the motor side. The motor's force does not
  /// change.
  void split(Parameters& crane) const {
    if (!carries()) return;
    (slew_ ? crane.jib_inertia_kgm2 : crane.trolley_inertia_kg) *= 1 - share_;
    (slew_ ? crane.slew_gain_radps2pv : crane.trolley_gain_mps2pv) /= 1 - share_;
    (slew_ ? crane.rotating_share : crane.centrifugal_share) = 0;
  }
  /// Inertia j J of the far side, kg or kg m2. @param crane  parameters after split()
  [[nodiscard]] double own_inertia(const Parameters& crane) const {
    return share_ / (1 - share_) * (slew_ ? crane.jib_inertia_kgm2 : crane.trolley_inertia_kg);
  }
  /// Force of the motor per volt, N/V or N m/V; it does not depend on j.
  [[nodiscard]] double motor_force(const Parameters& crane) const {
    return slew_ ? crane.jib_inertia_kgm2 * crane.slew_gain_radps2pv
                 : crane.trolley_inertia_kg * crane.trolley_gain_mps2pv;
  }
  /// j J / (total inertia of the far side); a jib also turns the trolley.
  [[nodiscard]] double own_share(const Parameters& crane, const State& seen) const {
    if (!slew_ || !carries()) return 1;
    const double own = own_inertia(crane);
    return own / (own + crane.trolley_mass_kg * radius_m(crane, seen) * radius_m(crane, seen));
  }
  /// Force P of the load on the far side, with the cable tension of a load at rest, N or N m. On a trolley, P
  /// includes the weight of the trolley along a tilted jib. 0 for a far side without inertia.
  /// @param cable  as for Term::add_force()
  [[nodiscard]] double load_force(const Parameters& crane, const State& seen,
                                  const motion::Angles<double>& cable) const {
    if (!carries()) return 0;
    const double tension_n = crane.load_mass_kg * crane.gravity_mps2 * cable.ct * cable.cf;
    const double radial_sine = cable.sf * crane.tilt_cosine + cable.cf * crane.tilt_sine;
    return slew_ ? tension_n * cable.st * radius_m(crane, seen)
                 : -tension_n * cable.ct * radial_sine -
                       crane.trolley_mass_kg * crane.gravity_mps2 * crane.tilt_sine;
  }
  /// Adds the force on the motor when the connection accelerates the inertia j J by `connection`, m/s2 or
  /// rad/s2. @param load_force  P
  void add_motor_reaction(const Parameters& crane, double connection, double load_force, Forces& sum) const {
    if (carries()) (slew_ ? sum.slew_nm : sum.trolley_n) -= own_inertia(crane) * connection + load_force;
  }
  /// Acceleration of the far side relative to the ground, m/s2 or rad/s2. @param load_force  P
  [[nodiscard]] double acceleration(const Parameters& crane, const State& seen, double connection,
                                    double load_force) const {
    if (!carries()) return connection;
    const double coriolis_nm = slew_ ? 2 * crane.trolley_mass_kg * radius_m(crane, seen) * crane.tilt_cosine *
                                           seen.trolley_mps * seen.slew_radps
                                     : 0;
    return own_share(crane, seen) * (connection + (load_force - coriolis_nm) / own_inertia(crane));
  }
  /// Decrease of the far side's speed when the connection increases the motor's speed by `change`.
  [[nodiscard]] double speed_loss(const Parameters& crane, const State& seen, double change) const {
    return change * own_share(crane, seen) * (1 - share_) / share_;
  }

 private:
  /// Horizontal distance of the trolley from the slew axis.
  [[nodiscard]] static double radius_m(const Parameters& crane, const State& seen) {
    return crane.tilt_cosine * seen.trolley_m;
  }
  bool slew_;
  double share_;
};

}  // namespace crane::plant
