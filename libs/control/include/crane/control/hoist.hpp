#pragma once
/// Cable position loop that every tracking shares; the hoist drive is speed-controlled.
#include "crane/control/law.hpp"

namespace crane::control {

/// V = (K_h (L_ref - L) + L_ref') / hoist_gain. @pre finite input, design without problems
[[nodiscard]] inline double hoist_volts(const Design& design, const Measurement& measured,
                                        const Reference& reference) noexcept {
  const AxisReference& cable = reference[kHoist];
  return (design.hoist_proportional_ps * (cable.position - measured.position[kHoist]) + cable.speed) /
         design.crane.hoist_gain_mpspv;
}

}  // namespace crane::control
