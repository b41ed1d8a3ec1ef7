#pragma once
/// Position loop of the cable. Every tracking law uses it. The hoist drive is speed-controlled.
#include "crane/control/law.hpp"

namespace crane::control {

/// @return V = (k_h (L_ref - L) + L_ref') / K_h with k_h = hoist_proportional_ps, K_h = hoist_gain_mpspv
/// @pre finite input, problems(design).empty()
[[nodiscard]] inline double hoist_volts(const Design& design, const Measurement& measured,
                                        const Reference& reference) noexcept {
  const AxisReference& cable = reference[kHoist];
  return (design.hoist_proportional_ps * (cable.position - measured.position[kHoist]) + cable.speed) /
         design.crane.hoist_gain_mpspv;
}

}  // namespace crane::control
