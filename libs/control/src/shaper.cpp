#include "crane/control/shaper.hpp"

#include "require.hpp"

namespace crane::control {

Shaper::Shaper(Shaping shaping, double load_period_s) {
  constexpr double kTolerated = 0.05;  // V of the shaper ei
  Requirements rules;
  rules.above_up_to("load_period_s", load_period_s, 0, 1e6);
  rules.throw_if_any();
  const double half_s = load_period_s / 2;
  if (shaping == Shaping::zv) {
    impulses_ = {{{0, 0.5}, {half_s, 0.5}, {}}};
    count_ = 2;
  } else if (shaping == Shaping::zvd || shaping == Shaping::ei) {
    const double outer = shaping == Shaping::ei ? (1 + kTolerated) / 4 : 0.25;
    impulses_ = {{{0, outer}, {half_s, 1 - 2 * outer}, {load_period_s, outer}}};
    count_ = 3;
  }
}

}  // namespace crane::control
