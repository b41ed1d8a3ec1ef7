#pragma once
/// Fuzzy anti-swing of section 3.3.2: seven labels per variable, triangular memberships with peaks at 0, +-a,
/// +-b, +-1 (figure 3.20; a = 1/3, b = 2/3 unless the design says otherwise), product inference, weighted
/// centroid. Inputs and output are scaled by (3.51):
///   x1 = phi / phi_max,  x2 = T phi' / 1.5,  Vbar_s = K_V y,  K_V = -90 phi_max  (tower sign)
/// Inputs beyond +-1 count as +-1.
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "crane/control/law.hpp"

namespace crane::control {

/// NB NM NS ZO PS PM PB as -3 .. 3.
using FuzzyLabel = int;
inline constexpr std::size_t kFuzzyLabels = 7;
/// "NB" .. "PB". @pre label in -3 .. 3
[[nodiscard]] std::string_view label_name(FuzzyLabel label) noexcept;

/// Peaks of PS and PM, the same for both inputs and the output; 0 < a < b < 1.
struct FuzzyPoints {
  double a = 1.0 / 3, b = 2.0 / 3;
};

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

/// Degrees of the rules, same order.
using FuzzyDegrees = std::array<std::array<double, kFuzzyLabels>, kFuzzyLabels>;

/// Table 3.8 as printed.
inline constexpr FuzzyDegrees kPrintedDegrees{{{.9902, .9536, .9613, .9505, .9937, .9834, 1.0000},
                                               {.9034, .5655, .9199, .5608, .7117, .9290, .9822},
                                               {.9802, .9437, .7393, .7657, .5910, .6448, .9608},
                                               {.9894, .8615, .8664, 1.0000, .8664, .8615, .9894},
                                               {.9608, .6448, .5910, .7657, .7393, .9437, .9802},
                                               {.9822, .9290, .7117, .5608, .9199, .5655, .9034},
                                               {1.0000, .9834, .9937, .9505, .9613, .9536, .9902}}};

/// y for scaled x1, x2; in [-1, 1]. At most four rules fire and their degrees add up to 1.
[[nodiscard]] double fuzzy_output(const FuzzyRules& rules, double swing, double swing_rate,
                                  const FuzzyPoints& points = {}) noexcept;

/// One observation of the law to be mapped, scaled.
struct FuzzySample {
  double swing = 0, swing_rate = 0, output = 0;
};

/// Rules of Wang and Mendel with the degree of each, (3.52); a rule no sample speaks for has degree 0, label
/// ZO.
struct GeneratedRules {
  FuzzyRules rules{};
  FuzzyDegrees degrees{};
};

/// Every sample proposes up to four rules; of conflicting ones that with the largest degree stays
/// (Tables 3.6-3.8).
[[nodiscard]] GeneratedRules rules_from(const std::vector<FuzzySample>& samples,
                                        const FuzzyPoints& points = {});

/// Response of the normalised linear model (3.27), (3.28) under delayed_1: initial swings of 2 to 30 degrees,
/// held before, and bang-coast-bang transfers of 0.25 to 1.5 cable lengths in three quarters of a period,
/// both directions.
[[nodiscard]] std::vector<FuzzySample> delayed_1_response(const Design& design);

/// The rules of fuzzy_generated: those of delayed_1_response() with the design's membership points.
[[nodiscard]] GeneratedRules generated_rules(const Design& design);

/// Places without a rule as "(NB, PS)": label of the swing, label of its rate. Empty when the table is
/// complete.
[[nodiscard]] std::vector<std::string> missing_rules(const GeneratedRules& generated);

/// How a table agrees with a printed one.
struct RuleAgreement {
  int exact = 0;                      ///< of the 49 rules
  int within_one = 0;                 ///< rules at most one label apart, the exact ones included
  double mean_degree_difference = 0;  ///< mean of |degree - printed degree|
};
[[nodiscard]] RuleAgreement agreement(const GeneratedRules& generated,
                                      const FuzzyRules& rules = kPrintedRules,
                                      const FuzzyDegrees& degrees = kPrintedDegrees) noexcept;

[[nodiscard]] std::unique_ptr<Law> make_fuzzy_printed(const Design& design);
/// Rules generated from the design's own delayed_1, a few milliseconds at start.
/// @pre missing_rules(generated_rules(design)).empty(), which problems(controller, design) sees to
[[nodiscard]] std::unique_ptr<Law> make_fuzzy_generated(const Design& design);

}  // namespace crane::control
