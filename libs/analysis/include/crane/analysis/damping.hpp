#pragma once
/// Damping ratios of a loop, -Re s / |s|, their maps over two gains (figures 3.16, 3.17, 3.19 of H. M. Omar,
/// Control of Gantry and Tower Cranes), and the gains of maximum damping.
#include <functional>
#include <span>

#include "crane/analysis/anti_swing_loop.hpp"

namespace crane::analysis {

/// Highest frequency Im s of the roots that count, in radians per load period: eight load frequencies. A
/// loop with delay has infinitely many roots, whose damping ratio tends to zero with increasing |s|. "All
/// roots" below are the roots up to this frequency.
inline constexpr double kHighestFrequency = 50.26548245743669;  // 16 pi

struct Damping {
  /// Damping ratio of the right-most complex pair, the measure of the source; 1 without a complex pair.
  double dominant = 1;
  double least = 1;  ///< minimum damping ratio of all roots; a real root counts as 1 (stable) or -1
  Complex dominant_root{}, least_root{};
  double right_most = 0;  ///< largest Re s of all roots; the loop is stable when it is negative
};

/// Damping of the given roots. @pre at least one root; Im s >= 0 for all roots
[[nodiscard]] Damping damping_of(std::span<const Complex> roots, double highest = kHighestFrequency);
/// Damping of the exact roots of f.
[[nodiscard]] Damping damping_of(const QuasiPolynomial& f, double highest = kHighestFrequency);
/// Damping of the roots with the Pade approximation (3.49) of the delay.
[[nodiscard]] Damping pade_damping_of(const QuasiPolynomial& f, int order,
                                      double highest = kHighestFrequency);

using LoopDamping = std::function<Damping(const GainPoint&)>;

struct DampingMap {
  GainRange first, second;
  std::vector<Damping> values;  ///< the first gain varies fastest
  [[nodiscard]] const Damping& at(int i, int j) const {
    return values[static_cast<std::size_t>(j) * static_cast<std::size_t>(first.points) +
                  static_cast<std::size_t>(i)];
  }
};
[[nodiscard]] DampingMap damping_map(const LoopDamping& damping, const GainRange& first,
                                     const GainRange& second);

enum class Measure { dominant, least };
/// Objective of the optimisation: the chosen measure for a stable loop, otherwise the minimum damping ratio.
[[nodiscard]] double merit(const Damping& damping, Measure measure) noexcept;

struct Optimum {
  GainPoint gains;
  Damping damping;
};
/// Gains with the largest merit within the ranges of the map. The simplex method of Nelder and Mead starts
/// from the best local maxima of the map, and restarts from its result until the improvement is negligible.
/// The result is a local maximum; there is no proof that it is the global one.
[[nodiscard]] Optimum optimum(const LoopDamping& damping, const DampingMap& map, Measure measure);

}  // namespace crane::analysis
