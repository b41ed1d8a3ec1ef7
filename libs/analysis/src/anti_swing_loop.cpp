#include "crane/analysis/anti_swing_loop.hpp"

#include <algorithm>
#include <numbers>

namespace crane::analysis {
namespace {

using std::numbers::pi;
using std::numbers::sqrt2;

const Polynomial kSquare{0, 0, 1};              // s^2
const Polynomial kPendulum{4 * pi * pi, 0, 1};  // (3.28) of H. M. Omar, Control of Gantry and Tower Cranes

Polynomial scaled(double factor, Polynomial p) {
  for (double& c : p) c *= factor;
  return p;
}

/// 1 + sqrt(2) s / w + (s / w)^2
Polynomial butterworth(const SwingFilter& filter) {
  if (filter.cutoff <= 0) return {1};
  return {1, sqrt2 / filter.cutoff, 1 / (filter.cutoff * filter.cutoff)};
}

}  // namespace

const AntiSwingKind* find_anti_swing(std::string_view name) noexcept {
  const auto* found = std::find_if(kAntiSwingKinds.begin(), kAntiSwingKinds.end(),
                                   [&](const AntiSwingKind& kind) { return kind.name == name; });
  return found == kAntiSwingKinds.end() ? nullptr : found;
}

QuasiPolynomial characteristic(AntiSwing law, const GainPoint& gains, const TrackingGains& tracking,
                               const SwingFilter& filter) {
  const Polynomial drive{tracking.proportional, tracking.derivative};  // K_p + K_d s
  QuasiPolynomial f;
  f.p = product(product(kPendulum, sum(kSquare, drive)), butterworth(filter));
  switch (law) {
    case AntiSwing::pd:
      f.q = scaled(-1, product(kSquare, {gains.first, gains.second}));
      break;
    case AntiSwing::delayed_1:
      f.q = scaled(-gains.first, kSquare);
      f.delay = gains.second;
      break;
    case AntiSwing::delayed_2:
      f.q = scaled(-gains.first, product(kSquare, drive));
      f.delay = gains.second;
      break;
  }
  return f;
}

QuasiPolynomial perfectly_tracked_delayed_2(const GainPoint& gains) {
  return {kPendulum, scaled(-gains.first, kSquare), gains.second};
}

}  // namespace crane::analysis
