#pragma once
/// What lies beyond a gap or a spring of an axis.
#include <cmath>

#include "crane/plant/equations.hpp"
#include "crane/plant/parameters.hpp"

namespace crane::plant {

/// A share j of the axis's inertia J, and what it carries: a jib the trolley and the load, a trolley the
/// load. With j = 0 it is only the point the load hangs from, and the motor turns everything.
class FarSide {
 public:
  FarSide(bool slew, double share) : slew_(slew), share_(share) {}

  [[nodiscard]] bool carries() const { return share_ > 0; }
  /// The motor moves what is on its side; its force stays what it was.
  void split(Parameters& crane) const {
    if (!carries()) return;
    (slew_ ? crane.jib_inertia_kgm2 : crane.trolley_inertia_kg) *= 1 - share_;
    (slew_ ? crane.slew_gain_radps2pv : crane.trolley_gain_mps2pv) /= 1 - share_;
    (slew_ ? crane.slewed_share : crane.thrown_share) = 0;
  }
  /// j J, kg or kg m2. @param crane after split()
  [[nodiscard]] double own_inertia(const Parameters& crane) const {
    return share_ / (1 - share_) * (slew_ ? crane.jib_inertia_kgm2 : crane.trolley_inertia_kg);
  }
  /// Of all its inertia: a jib turns the trolley too.
  [[nodiscard]] double own_part(const Parameters& crane, const State& seen) const {
    if (!slew_ || !carries()) return 1;
    const double own = own_inertia(crane);
    return own / (own + crane.trolley_mass_kg * seen.trolley_m * seen.trolley_m);
  }
  /// P, what a load that hangs at rest pulls with, N or N m.
  [[nodiscard]] double pull(const Parameters& crane, const State& seen) const {
    const double ct = std::cos(seen.tangential_rad), cf = std::cos(seen.radial_rad);
    const double tension_n = crane.load_mass_kg * crane.gravity_mps2 * ct * cf;
    return slew_ ? tension_n * std::sin(seen.tangential_rad) * seen.trolley_m
                 : -tension_n * ct * std::sin(seen.radial_rad);
  }
  /// Force on the motor when the connection gives the own inertia the acceleration `connection`.
  void push_back(const Parameters& crane, const State& seen, double connection, Forces& sum) const {
    if (carries())
      (slew_ ? sum.slew_nm : sum.trolley_n) -= own_inertia(crane) * connection + pull(crane, seen);
  }
  /// Its own acceleration over ground, m/s2 or rad/s2.
  [[nodiscard]] double acceleration(const Parameters& crane, const State& seen, double connection) const {
    if (!carries()) return connection;
    const double coriolis_nm =
        slew_ ? 2 * crane.trolley_mass_kg * seen.trolley_m * seen.trolley_mps * seen.slew_radps : 0;
    return own_part(crane, seen) * (connection + (pull(crane, seen) - coriolis_nm) / own_inertia(crane));
  }
  /// What a change of the motor's speed that only the connection can have made has taken from its speed.
  [[nodiscard]] double passed_on(const Parameters& crane, const State& seen, double change) const {
    return change * own_part(crane, seen) * (1 - share_) / share_;
  }

 private:
  bool slew_;
  double share_;
};

}  // namespace crane::plant
