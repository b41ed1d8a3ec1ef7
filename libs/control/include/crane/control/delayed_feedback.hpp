#pragma once
/// Anti-swing by delayed swing feedback, section 3.3.2.
///   delayed_1: Vbar_s = K_del phi(t - tau_del T)      (3.47), tower sign: K_del < 0
/// on the trolley, the same with theta on the slew axis through (3.37), (3.38). Characteristic equation,
/// normalised:
///   (s^2 + 4 pi^2)(s^2 + K_d s + K_p) - K_del s^2 exp(-tau_del s) = 0        (3.48) with corrected sign
///   delayed_2: x_ref corrected by L K_del phi(t - tau_del T), the tracking PD does the rest (figure 3.18);
///   in y
/// of (3.34) the slew reference is corrected by -(L/x) K_del theta(t - tau_del T). The corrections carry
/// their speed, from the delayed swing rate. Characteristic equation with K_del < 0 (tower sign):
///   (s^2 + 4 pi^2)(s^2 + K_d s + K_p) - K_del s^2 (K_d s + K_p) exp(-tau_del s) = 0          (3.50)
#include <memory>

#include "crane/control/law.hpp"

namespace crane::control {

[[nodiscard]] std::unique_ptr<Law> make_delayed_1(const Design& design);
[[nodiscard]] std::unique_ptr<Law> make_delayed_2(const Design& design);

}  // namespace crane::control
