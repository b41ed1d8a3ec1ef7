#include "crane/supervisor/component.hpp"

namespace crane::supervisor {

Limits limits_of(const configuration::Rig& rig) {
  Limits limits;
  for (std::size_t i = 0; i < kAxes; ++i) limits.axis[i] = rig.drives[i];
  limits.period_s = rig.period_s;
  limits.swing_limit_rad = rig.limits.swing_limit_rad;
  limits.demand_stale_after_ticks = rig.ticks_in(rig.limits.demand_stale_after_s);
  limits.idle_lock_s = rig.limits.idle_lock_s;
  return limits;
}

}  // namespace crane::supervisor
