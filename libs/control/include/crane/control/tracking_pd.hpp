#pragma once
/// Tracking PD with feedback linearisation, which makes each axis a double integrator. Time is normalised by
/// the load period T.
/// Source: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003, section 3.3.
///   Vbar_x = (K_p e + T K_d e') / L,  e = x_ref - x                           (3.40)
///   Vbar_y = K_p e_y + T K_d e_y',    e_y = -(x/L) (gamma_ref - gamma)        (3.40) with y of (3.34)
/// (3.37) and (3.38) convert both to volts. x cancels in (3.38), so that the slew axis needs no 1/x:
///   V_gamma = ((1 + M_r x^2)/T^2 (K_p e + T K_d e') - m_r g x theta) / K_mgamma
/// With K_d = 2 sqrt(K_p) (3.42) both loops are critically damped.
#include <memory>

#include "crane/control/law.hpp"

namespace crane::control {

[[nodiscard]] std::unique_ptr<Law> make_tracking_pd(const Design& design);

/// Anti-swing law of the controller `none`: its contribution is 0 V.
[[nodiscard]] std::unique_ptr<Law> make_no_anti_swing(const Design& design);

}  // namespace crane::control
