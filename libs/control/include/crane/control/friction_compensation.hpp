#pragma once
/// Friction compensation of one drive.
/// Source: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003.
/// The volts F_f/K_m are added to the control volts V: u = V + F_f/K_m (3.5). With v the speed and d_s the
/// zero band, F_f/K_m is:
///   v >  d_s:    c+ + b+ v                          (3.1), corrected signs
///   v < -d_s:   -c- + b- v
///   |v| <= d_s:  f_s+ tanh(A V) for V > 0,  f_s- tanh(A V) for V < 0
/// The last line differs from (3.2), f_sh + f_s tanh(A V) with
///   f_s = (f_s+ + f_s-)/2,   f_sh = (f_s+ - f_s-)/2
/// Both have the same limits for large |V|. At V = 0 the source has f_sh, which moves a drive with
/// unequal friction without a control voltage; here the compensation is 0.
#include "crane/control/law.hpp"

namespace crane::control {

/// @param control_v  V, sum of the contributions of this tick
/// @param speed      measured speed of the axis, m/s or rad/s
/// @return volts to add: `factor` times the friction; |result| <= 1.5e9 for any finite input
/// @pre friction.problems().empty()
[[nodiscard]] double friction_compensation_v(const DriveFriction& friction, double control_v,
                                             double speed) noexcept;

}  // namespace crane::control
