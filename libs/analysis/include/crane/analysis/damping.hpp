#pragma once
/// Damping ratios of a loop, -Re s / |s|, their map over the plane of two gains (figures 3.16, 3.17, 3.19)
/// and the gains where they are largest.
#include <functional>
#include <span>

#include "crane/analysis/anti_swing_loop.hpp"

namespace crane::analysis {

/// A delay brings endless chains of roots whose damping ratio tends to zero as they grow, though they decay
/// ever faster. What is said about "all" roots here is therefore about those with Im s at most eight load
/// frequencies, unless another limit is given.
inline constexpr double kHighest = 50.26548245743669;  // 16 pi

struct Damping {
  double dominant = 1;  ///< of the right-most complex pair, the source's measure; 1 when there is none
  double least = 1;     ///< of all roots, real ones counting 1 or -1
  Complex dominant_root{}, least_root{};
  double right_most = 0;  ///< largest Re s of all roots; the loop is stable when it is negative
};

/// Of roots with Im s >= 0, at least one.
[[nodiscard]] Damping damping_of(std::span<const Complex> roots, double highest = kHighest);
/// Of the exact roots.
[[nodiscard]] Damping damping_of(const QuasiPolynomial& f, double highest = kHighest);
/// Of the roots with (3.49) in the place of the delay.
[[nodiscard]] Damping pade_damping_of(const QuasiPolynomial& f, int order, double highest = kHighest);

using LoopDamping = std::function<Damping(const GainPoint&)>;

struct DampingMap {
  GainRange first, second;
  std::vector<Damping> values;  ///< first fastest
  [[nodiscard]] const Damping& at(int i, int j) const {
    return values[static_cast<std::size_t>(j) * static_cast<std::size_t>(first.points) +
                  static_cast<std::size_t>(i)];
  }
};
[[nodiscard]] DampingMap damping_map(const LoopDamping& damping, const GainRange& first,
                                     const GainRange& second);

enum class Measure { dominant, least };
/// What is made large; the least damping where the loop is not stable.
[[nodiscard]] double merit(const Damping& damping, Measure measure) noexcept;

struct Optimum {
  GainPoint gains;
  Damping damping;
};
/// Largest merit inside the map's ranges: from the map's best local maxima by Nelder and Mead's simplex,
/// begun anew where it stopped until that no longer helps. Numerical, not proven global.
[[nodiscard]] Optimum optimum(const LoopDamping& damping, const DampingMap& map, Measure measure);

}  // namespace crane::analysis
