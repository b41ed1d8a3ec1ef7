#include "crane/control/fuzzy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "crane/control/schedule.hpp"

namespace crane::control {
namespace {

using Peaks = std::array<double, kFuzzyLabels>;

constexpr Peaks peaks_of(const FuzzyPoints& points) noexcept {
  return {-1, -points.b, -points.a, 0, points.a, points.b, 1};
}

// Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes (fuzzy.hpp).

/// The two labels that a scaled value belongs to. The degrees of membership add up to 1.
struct Membership {
  std::size_t lower = 0;    ///< index (label + 3) of the lower label, 0 to 5
  double upper_degree = 0;  ///< degree of membership in label lower + 1, in [0, 1]
};

Membership membership(const Peaks& peaks, double scaled) noexcept {
  const double held = std::clamp(scaled, -1.0, 1.0);
  std::size_t lower = 0;  // NaN gives index 0 and degree NaN
  while (lower < kFuzzyLabels - 2 && held >= peaks[lower + 1]) ++lower;
  return {lower, (held - peaks[lower]) / (peaks[lower + 1] - peaks[lower])};
}

class Fuzzy final : public Law {
 public:
  Fuzzy(const Design& design, const FuzzyRules& rules)
      : design_(design), points_{design.fuzzy_point_a, design.fuzzy_point_b}, rules_(rules) {}

  Contribution step(const Measurement& raw, const Reference& /*reference*/) noexcept override {
    const Measurement measured = bounded(raw);
    const Schedule at = schedule(design_, measured);
    const auto vbar = [&](double swing_rad, double swing_radps) {  // (3.51)
      const double y = fuzzy_output(rules_, swing_rad / design_.fuzzy_swing_rad,
                                    at.load_period_s * swing_radps / design_.fuzzy_swing_rate, points_);
      return design_.fuzzy_gain * design_.fuzzy_swing_rad * y;
    };
    Contribution result;
    result.drive_v[kTrolley] =
        trolley_volts(design_.crane, at, vbar(measured.swing_radial_rad, measured.swing_radial_radps));
    result.drive_v[kSlew] =
        slew_volts(design_.crane, at, vbar(measured.swing_tangential_rad, measured.swing_tangential_radps));
    return result;
  }
  void reset(const Measurement& /*measured*/) noexcept override {}

 private:
  Design design_;
  FuzzyPoints points_;
  FuzzyRules rules_;
};

}  // namespace

std::string_view label_name(FuzzyLabel label) noexcept {
  constexpr std::array<std::string_view, kFuzzyLabels> kNames{"NB", "NM", "NS", "ZO", "PS", "PM", "PB"};
  return kNames[static_cast<std::size_t>(label + 3)];
}

double fuzzy_output(const FuzzyRules& rules, double swing, double swing_rate,
                    const FuzzyPoints& points) noexcept {
  const Peaks peaks = peaks_of(points);
  const Membership row = membership(peaks, swing), column = membership(peaks, swing_rate);
  const auto peak = [&](std::size_t r, std::size_t c) {
    return peaks[static_cast<std::size_t>(rules[r][c] + 3)];
  };
  const auto along_row = [&](std::size_t r) {
    return (1 - column.upper_degree) * peak(r, column.lower) +
           column.upper_degree * peak(r, column.lower + 1);
  };
  return (1 - row.upper_degree) * along_row(row.lower) + row.upper_degree * along_row(row.lower + 1);
}

GeneratedRules rules_from(const std::vector<FuzzySample>& samples, const FuzzyPoints& points) {
  const Peaks peaks = peaks_of(points);
  GeneratedRules result;
  for (const auto& sample : samples) {
    const auto [below, above_degree] = membership(peaks, sample.output);
    const bool above = above_degree >= 0.5;
    const FuzzyLabel label = static_cast<FuzzyLabel>(below) - 3 + (above ? 1 : 0);
    const double output_degree = above ? above_degree : 1 - above_degree;
    const auto [row, row_degree] = membership(peaks, sample.swing);
    const auto [column, column_degree] = membership(peaks, sample.swing_rate);
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j) {
        const double degree = output_degree * (i == 1 ? row_degree : 1 - row_degree) *
                              (j == 1 ? column_degree : 1 - column_degree);  // (3.52)
        if (degree <= result.degrees[row + i][column + j]) continue;
        result.degrees[row + i][column + j] = degree;
        result.rules[row + i][column + j] = label;
      }
  }
  return result;
}

GeneratedRules generated_rules(const Design& design) {
  return rules_from(delayed_1_response(design), {design.fuzzy_point_a, design.fuzzy_point_b});
}

std::vector<std::string> missing_rules(const GeneratedRules& generated) {
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < kFuzzyLabels; ++i)
    for (std::size_t j = 0; j < kFuzzyLabels; ++j)
      if (!(generated.degrees[i][j] > 0))
        missing.push_back("(" + std::string(label_name(static_cast<FuzzyLabel>(i) - 3)) + ", " +
                          std::string(label_name(static_cast<FuzzyLabel>(j) - 3)) + ")");
  return missing;
}

RuleAgreement agreement(const GeneratedRules& generated, const FuzzyRules& rules,
                        const FuzzyDegrees& degrees) noexcept {
  RuleAgreement result;
  double difference = 0;
  for (std::size_t i = 0; i < kFuzzyLabels; ++i)
    for (std::size_t j = 0; j < kFuzzyLabels; ++j) {
      const int apart = std::abs(generated.rules[i][j] - rules[i][j]);
      result.exact += apart == 0 ? 1 : 0;
      result.within_one += apart <= 1 ? 1 : 0;
      difference += std::abs(generated.degrees[i][j] - degrees[i][j]);
    }
  result.mean_degree_difference = difference / static_cast<double>(kFuzzyLabels * kFuzzyLabels);
  return result;
}

std::unique_ptr<Law> make_fuzzy_printed(const Design& design) {
  return std::make_unique<Fuzzy>(design, kPrintedRules);
}
std::unique_ptr<Law> make_fuzzy_generated(const Design& design) {
  return std::make_unique<Fuzzy>(design, generated_rules(design).rules);
}

}  // namespace crane::control
