#include "crane/control/zero_phase.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "require.hpp"

namespace crane::control {
namespace {

using std::numbers::pi;

/// Number of samples in which the slowest mode of the filter decays to exp(-12). Its pole z satisfies
/// ln |z| <= -sin(2 pi cutoff_ratio) sin(pi / (2 order)).
std::size_t settling_samples(double cutoff_ratio, int order) {
  return static_cast<std::size_t>(
      std::ceil(12 / (std::sin(2 * pi * cutoff_ratio) * std::sin(pi / (2 * order)))));
}

/// The samples, extended at both ends by `margin` samples of their odd reflection. @pre margin <
/// samples.size()
std::vector<double> continued(std::span<const double> samples, std::size_t margin) {
  std::vector<double> result;
  result.reserve(samples.size() + 2 * margin);
  for (std::size_t k = margin; k > 0; --k) result.push_back(2 * samples.front() - samples[k]);
  result.insert(result.end(), samples.begin(), samples.end());
  for (std::size_t k = 1; k <= margin; ++k)
    result.push_back(2 * samples.back() - samples[samples.size() - 1 - k]);
  return result;
}

void run_forwards(const std::vector<FilterSection>& sections, std::vector<double>& series) {
  for (const FilterSection& section : sections) {
    const double first = series.front();
    FilterMemory memory{first, first, first, first};  // settled: the steady-state gain is one
    for (double& value : series) value = step(section, memory, value);
  }
}

}  // namespace

std::vector<FilterSection> butterworth_sections(double cutoff_ratio, int order) {
  Requirements rules;
  rules.require(cutoff_ratio >= 1e-4 && cutoff_ratio < 0.5, "cutoff_ratio", cutoff_ratio,
                "must be in [0.0001, 0.5)");
  rules.in_range("order", order, 1, 12);
  rules.throw_if_any();
  const double w = std::tan(pi * cutoff_ratio);  // prewarped cut-off frequency
  std::vector<FilterSection> sections;
  for (int pair = 0; pair < order / 2; ++pair) {
    const double damping = 2 * std::sin((2 * pair + 1) * pi / (2 * order));
    const double norm = 1 / (1 + damping * w + w * w), gain = w * w * norm;
    sections.push_back({gain, 2 * gain, gain, 2 * (w * w - 1) * norm, (1 - damping * w + w * w) * norm});
  }
  if (order % 2 == 1) sections.push_back({w / (1 + w), w / (1 + w), 0, (w - 1) / (1 + w), 0});
  return sections;
}

std::vector<double> zero_phase_butterworth(std::span<const double> samples, double cutoff_ratio, int order) {
  const auto sections = butterworth_sections(cutoff_ratio, order);
  if (samples.size() < 2) return {samples.begin(), samples.end()};
  const std::size_t margin = std::min(settling_samples(cutoff_ratio, order), samples.size() - 1);
  std::vector<double> series = continued(samples, margin);
  for (int pass = 0; pass < 2; ++pass) {
    run_forwards(sections, series);
    std::reverse(series.begin(), series.end());
  }
  const auto first = series.begin() + static_cast<std::ptrdiff_t>(margin);
  return {first, first + static_cast<std::ptrdiff_t>(samples.size())};
}

}  // namespace crane::control
