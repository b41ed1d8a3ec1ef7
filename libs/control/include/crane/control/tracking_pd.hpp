#pragma once
/// Tracking PD of section 3.3 in normalised time with feedback linearisation: both axes become double
/// integrators.
///   Vbar_x = (K_p e + T K_d e') / L                             (3.40), e = x_ref - x
///   Vbar_y = K_p e_y + T K_d e_y',  e_y = -(x/L) (gamma_ref - gamma)   (3.40) in y of (3.34)
/// turned into volts by (3.37) and (3.38). In (3.38) x cancels, so the slew axis has no 1/x here:
///   V_gamma = ((1 + M_r x^2)/T^2 (K_p e + T K_d e') - m_r g x theta) / K_mgamma
/// K_d = 2 sqrt(K_p) (3.42) makes both loops critically damped.
#include <memory>

#include "crane/control/law.hpp"

namespace crane::control {

[[nodiscard]] std::unique_ptr<Law> make_tracking_pd(const Design& design);

/// Contributes nothing: tracking only.
[[nodiscard]] std::unique_ptr<Law> make_no_anti_swing(const Design& design);

}  // namespace crane::control
