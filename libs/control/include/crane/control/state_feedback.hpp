#pragma once
/// State feedback with constant gains, for a law that was designed elsewhere (LQR, pole placement):
///
///   V = k_p (r - q) - k_v q' - k_s s - k_r s'
///
/// q is trolley position or slew angle, s the swing angle in its plane (phi, theta; signs of
/// docs/equations.md). The tracking law computes the terms in r, q and q' and drives the hoist. The
/// anti-swing law computes the terms in s and s'. The gains are constant: they are designed for one cable
/// length and, on the slew axis, for one trolley position.
#include <memory>

#include "crane/control/law.hpp"

namespace crane::control {

/// Any finite number is permitted. The designer must check stability (`crane analyse`).
struct StateFeedbackAxis {
  double position = 0;    ///< k_p [V/m, V/rad]
  double speed = 0;       ///< k_v [V s/m, V s/rad]
  double swing = 0;       ///< k_s [V/rad]
  double swing_rate = 0;  ///< k_r [V s/rad]
};

struct StateFeedbackGains {
  StateFeedbackAxis trolley, slew;
};

[[nodiscard]] std::unique_ptr<Law> make_state_feedback_tracking(const Design& design,
                                                                const StateFeedbackGains& gains);
[[nodiscard]] std::unique_ptr<Law> make_state_feedback_anti_swing(const Design& design,
                                                                  const StateFeedbackGains& gains);

}  // namespace crane::control
