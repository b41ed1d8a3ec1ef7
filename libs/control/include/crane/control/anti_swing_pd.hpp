#pragma once
/// Anti-swing PD of section 3.3.2 in normalised time, tower sign (K_ps < 0, K_ds > 0):
///   Vbar_s = K_ps phi + T K_ds phi'                                              (3.45)
/// on the trolley, the same with theta on the slew axis through (3.37), (3.38). Characteristic equation:
///   (s^2 + 4 pi^2)(s^2 + K_d s + K_p) - s^2 (K_ds s + K_ps) = 0                  (3.39) with corrected sign
#include <memory>

#include "crane/control/law.hpp"

namespace crane::control {

[[nodiscard]] std::unique_ptr<Law> make_anti_swing_pd(const Design& design);

}  // namespace crane::control
