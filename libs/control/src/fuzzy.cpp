#include "crane/control/fuzzy.hpp"

#include <algorithm>
#include <cmath>

#include "crane/control/schedule.hpp"

namespace crane::control {
namespace {

constexpr int kLargestLabel = 3;

/// The two labels a scaled value belongs to and its degree in the upper one.
struct Membership {
  std::size_t lower = 0;  ///< index, label + 3; at most 5, so that lower + 1 exists
  double upper_degree = 0;
};

Membership membership(double scaled) noexcept {
  const double place = (std::clamp(scaled, -1.0, 1.0) + 1) * kLargestLabel;
  const double last = static_cast<double>(kFuzzyLabels - 2);
  const double lower = place >= 1 ? std::min(std::floor(place), last) : 0;  // NaN: a valid index, degree NaN
  return {static_cast<std::size_t>(lower), place - lower};
}

class Fuzzy final : public Law {
 public:
  Fuzzy(const Design& design, const FuzzyRules& rules) : design_(design), rules_(rules) {}

  Contribution step(const Measurement& raw, const Reference& /*reference*/) noexcept override {
    const Measurement measured = bounded(raw);
    const Schedule at = schedule(design_, measured);
    const auto vbar = [&](double swing_rad, double swing_radps) {
      const double y = fuzzy_output(rules_, swing_rad / design_.fuzzy_swing_rad,
                                    at.load_period_s * swing_radps / design_.fuzzy_swing_rate);
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
  FuzzyRules rules_;
};

}  // namespace

double fuzzy_output(const FuzzyRules& rules, double swing, double swing_rate) noexcept {
  const Membership row = membership(swing), column = membership(swing_rate);
  const auto along_row = [&](std::size_t r) {
    return (1 - column.upper_degree) * rules[r][column.lower] +
           column.upper_degree * rules[r][column.lower + 1];
  };
  return ((1 - row.upper_degree) * along_row(row.lower) + row.upper_degree * along_row(row.lower + 1)) /
         kLargestLabel;
}

GeneratedRules rules_from(const std::vector<FuzzySample>& samples) {
  GeneratedRules result;
  for (const auto& sample : samples) {
    const double output = std::clamp(sample.output, -1.0, 1.0) * kLargestLabel;
    const auto label = static_cast<FuzzyLabel>(std::lround(output));
    const double output_degree = 1 - std::abs(output - label);
    const auto [row, row_degree] = membership(sample.swing);
    const auto [column, column_degree] = membership(sample.swing_rate);
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j) {
        const double degree = output_degree * (i == 1 ? row_degree : 1 - row_degree) *
                              (j == 1 ? column_degree : 1 - column_degree);
        if (degree <= result.degrees[row + i][column + j]) continue;
        result.degrees[row + i][column + j] = degree;
        result.rules[row + i][column + j] = label;
      }
  }
  return result;
}

std::unique_ptr<Law> make_fuzzy_printed(const Design& design) {
  return std::make_unique<Fuzzy>(design, kPrintedRules);
}
std::unique_ptr<Law> make_fuzzy_generated(const Design& design) {
  return std::make_unique<Fuzzy>(design, rules_from(delayed_1_response(design)).rules);
}

}  // namespace crane::control
