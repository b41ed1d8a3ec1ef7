#pragma once
/// Anti-swing PD. Source: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003, section 3.3.2.
/// Time is normalised by the load period T.
/// Signs: docs/equations.md#coordinates-and-signs (K_ps < 0, K_ds > 0).
///   trolley  Vbar_s = K_ps phi   + T K_ds phi'                                   (3.45)
///   slew     Vbar_s = K_ps theta + T K_ds theta'
/// The first parts of (3.37) and (3.38) convert Vbar_s to volts. Characteristic equation:
///   (s^2 + 4 pi^2)(s^2 + K_d s + K_p) - s^2 (K_ds s + K_ps) = 0                  (3.39), corrected sign
#include <memory>

#include "crane/control/law.hpp"

namespace crane::control {

/// @pre problems(design).empty()
[[nodiscard]] std::unique_ptr<Law> make_anti_swing_pd(const Design& design);

}  // namespace crane::control
