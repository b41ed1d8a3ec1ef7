#pragma once
/// LuGre friction (Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE TAC 40 (1995) 419):
///   z' = v - |v| z / z_c(v),  f = s0 z + s1 exp(-(v / v_d)^2) z',  z_c = level(v) / s0
/// with a damping that decreases with speed (Olsson, Control Systems with Friction, Lund 1996): a constant
/// damping causes peaks of many times the level after each reversal, which real bearings do not show. The
/// deflection z is integrated separately from the motion, exactly for constant v: at speed the bristles relax
/// within microseconds, which an explicit step of the motion cannot resolve.
#include <algorithm>
#include <cmath>

namespace truth {

struct Bristles {
  double stiffness = 0;  ///< s0, force per m or rad; 0: no friction
  double damping = 0;    ///< s1, force per m/s or rad/s
  double fading = 1;     ///< v_d, m/s or rad/s
  double z = 0;

  /// @param level force at which the bristles slide @param acceleration_per_force of the body that they hold
  static Bristles of(double level, double presliding, double acceleration_per_force) {
    Bristles b;
    b.stiffness = level / presliding;
    const double natural_radps = std::sqrt(b.stiffness * std::max(acceleration_per_force, 1e-9));
    b.damping = b.stiffness / natural_radps;  // half the critical damping
    b.fading = presliding * natural_radps;
    return b;
  }

  [[nodiscard]] double force(double speed, double level) const {
    if (stiffness <= 0 || level <= 0) return 0;
    const double share = std::exp(-speed * speed / (fading * fading));
    return stiffness * z + share * damping * (speed - std::abs(speed) * z * stiffness / level);
  }

  void advance(double speed, double level, double span_s) {
    if (stiffness <= 0 || level <= 0) {
      z = 0;
      return;
    }
    const double slid = level / stiffness, end = speed < 0 ? -slid : slid;
    z = end + (z - end) * std::exp(-std::abs(speed) * span_s / slid);
  }
};

}  // namespace truth
