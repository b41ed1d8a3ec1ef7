#pragma once
/// Fuzzy anti-swing of section 3.3.2: seven labels per input, triangular memberships with a = 1/3, b = 2/3
/// (figure 3.20), product inference, weighted centroid. Inputs and output are scaled by (3.51):
///   x1 = phi / phi_max,  x2 = T phi' / 1.5,  Vbar_s = K_V y,  K_V = -90 phi_max  (tower sign)
/// Inputs beyond +-1 count as +-1.
#include <array>
#include <memory>
#include <vector>

#include "crane/control/law.hpp"

namespace crane::control {

/// NB NM NS ZO PS PM PB as -3 .. 3; its membership peaks at label / 3.
using FuzzyLabel = int;
inline constexpr std::size_t kFuzzyLabels = 7;
/// [label of swing + 3][label of swing rate + 3]
using FuzzyRules = std::array<std::array<FuzzyLabel, kFuzzyLabels>, kFuzzyLabels>;

/// Table 3.7 as printed; (PB, PS) = PM is its only break of odd symmetry and probably a misprint.
inline constexpr FuzzyRules kPrintedRules{{{-1, -3, -3, -3, -3, -3, -3},
                                           {3, 1, -1, -2, -2, -3, -3},
                                           {3, 0, 0, -1, -2, -3, -3},
                                           {3, 2, 1, 0, -1, -2, -3},
                                           {3, 3, 2, 1, 0, 0, -3},
                                           {3, 3, 2, 2, 1, -1, -3},
                                           {3, 3, 3, 3, 2, 3, 1}}};

/// y for scaled x1, x2; in [-1, 1]. At most four rules fire and their degrees add up to 1.
[[nodiscard]] double fuzzy_output(const FuzzyRules& rules, double swing, double swing_rate) noexcept;

/// One observation of the law to be mapped, scaled.
struct FuzzySample {
  double swing = 0, swing_rate = 0, output = 0;
};

/// Rules of Wang and Mendel with the degree of each, (3.52); a rule no sample speaks for has degree 0, label
/// ZO.
struct GeneratedRules {
  FuzzyRules rules{};
  std::array<std::array<double, kFuzzyLabels>, kFuzzyLabels> degrees{};
};

/// Every sample proposes up to four rules; of conflicting ones that with the largest degree stays
/// (Tables 3.6-3.8).
[[nodiscard]] GeneratedRules rules_from(const std::vector<FuzzySample>& samples);

/// Response of the normalised linear model (3.27), (3.28) under delayed_1: initial swings of 2 to 30 degrees,
/// held before, and bang-coast-bang transfers of 0.25 to 1.5 cable lengths in one period, both directions.
[[nodiscard]] std::vector<FuzzySample> delayed_1_response(const Design& design);

[[nodiscard]] std::unique_ptr<Law> make_fuzzy_printed(const Design& design);
/// Rules generated from the design's own delayed_1, a few milliseconds at start.
[[nodiscard]] std::unique_ptr<Law> make_fuzzy_generated(const Design& design);

}  // namespace crane::control
