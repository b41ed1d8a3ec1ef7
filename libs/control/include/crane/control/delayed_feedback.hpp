#pragma once
/// Anti-swing by delayed swing feedback. Time is normalised by the load period T.
/// Source: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003, section 3.3.2.
/// Signs: docs/equations.md#coordinates-and-signs (K_del < 0).
///
/// delayed_1 adds volts to the drives; the first parts of (3.37), (3.38) convert Vbar_s to volts:
///   trolley  Vbar_s = K_del phi(t - tau_del T)                               (3.47)
///   slew     Vbar_s = K_del theta(t - tau_del T)
///   (s^2 + 4 pi^2)(s^2 + K_d s + K_p) - K_del s^2 exp(-tau_del s) = 0        (3.48), corrected sign
///
/// delayed_2 adds corrections to the reference of the tracking PD (figure 3.18). Each correction has a
/// position and, from the delayed swing rate, a speed:
///   trolley  L K_del phi(t - tau_del T)
///   slew     -(L/x) K_del theta(t - tau_del T), from y of (3.34)
///   (s^2 + 4 pi^2)(s^2 + K_d s + K_p) - K_del s^2 (K_d s + K_p) exp(-tau_del s) = 0
///                                                                            (3.50), corrected sign
#include <memory>

#include "crane/control/law.hpp"

namespace crane::control {

/// @pre problems(design).empty()
[[nodiscard]] std::unique_ptr<Law> make_delayed_1(const Design& design);
[[nodiscard]] std::unique_ptr<Law> make_delayed_2(const Design& design);

}  // namespace crane::control
