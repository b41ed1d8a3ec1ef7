#include "crane/analysis/damping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "crane/analysis/pade.hpp"
#include "crane/analysis/roots.hpp"

namespace crane::analysis {
namespace {

constexpr double kFirstAbscissa = -25, kLastAbscissa = -400;

double ratio(Complex s) { return s == 0.0 ? 0 : -s.real() / std::abs(s); }

}  // namespace

Damping damping_of(std::span<const Complex> roots, double highest) {
  Damping damping;
  damping.right_most = -std::numeric_limits<double>::infinity();
  double dominant_re = damping.right_most;
  bool first = true;
  for (const Complex& s : roots) {
    if (s.imag() > highest) continue;
    damping.right_most = std::max(damping.right_most, s.real());
    if (first || ratio(s) < damping.least) damping.least = ratio(s), damping.least_root = s;
    first = false;
    if (s.imag() <= 0 || s.real() <= dominant_re) continue;
    dominant_re = s.real();
    damping.dominant = ratio(s);
    damping.dominant_root = s;
  }
  return damping;
}

Damping damping_of(const QuasiPolynomial& f, double highest) {
  const double right = root_bound(f, 0);
  Damping damping;
  for (double left = kFirstAbscissa; left >= kLastAbscissa; left *= 2) {
    const auto roots = roots_in(f, left, right, highest);
    damping = damping_of(roots, highest);
    // Roots with Re s < left and Im s <= highest have at least this damping ratio.
    const bool settled = damping.least <= -left / std::hypot(left, highest);
    if (!roots.empty() && settled && damping.dominant_root != 0.0) break;
  }
  return damping;
}

Damping pade_damping_of(const QuasiPolynomial& f, int order, double highest) {
  return damping_of(pade_roots(f, order), highest);
}

DampingMap damping_map(const LoopDamping& damping, const GainRange& first, const GainRange& second) {
  DampingMap map{first, second, {}};
  for (int j = 0; j < second.points; ++j)
    for (int i = 0; i < first.points; ++i) map.values.push_back(damping({first.at(i), second.at(j)}));
  return map;
}

double merit(const Damping& damping, Measure measure) noexcept {
  const bool stable = damping.right_most < 0;
  return measure == Measure::dominant && stable ? damping.dominant : damping.least;
}

}  // namespace crane::analysis
