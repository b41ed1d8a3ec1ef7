#include "data/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "data/median.hpp"

namespace crane::diagnosis {
namespace {

/// Differences of values are multiples of the resolution within this share of it, except a share of outliers
/// (values with few printed digits, a spike).
constexpr double kLatticeTolerance = 0.05, kLargestStrayShare = 0.02;
/// Rounding of doubles, as a share of the values.
constexpr double kRoundingShare = 1e-12;
/// Differences of larger numbers overflow.
constexpr double kLargest = 1e50;
/// Steps in the smallest difference, at most.
constexpr int kMostSteps = 64;

std::vector<double> finite(std::span<const double> values) {
  std::vector<double> kept;
  std::copy_if(values.begin(), values.end(), std::back_inserter(kept),
               [](double x) { return std::abs(x) < kLargest; });
  return kept;
}

bool are_multiples(const std::vector<double>& differences, double step) {
  std::size_t strays = 0;
  for (const double difference : differences) {
    const double steps = difference / step;
    strays += std::abs(steps - std::round(steps)) > kLatticeTolerance ? 1 : 0;
  }
  return static_cast<double>(strays) <= kLargestStrayShare * static_cast<double>(differences.size());
}

double resolution_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double largest = std::max(std::abs(values.front()), std::abs(values.back()));
  std::vector<double> differences;
  for (std::size_t k = 1; k < values.size(); ++k)
    if (const double step = values[k] - values[k - 1]; step > kRoundingShare * largest)
      differences.push_back(step);
  if (differences.empty()) return 0;
  const double least = *std::min_element(differences.begin(), differences.end());
  for (int steps = 1; steps <= kMostSteps; ++steps)
    if (are_multiples(differences, least / steps)) return least / steps;
  return least;
}

/// Third differences of a smooth motion vanish; of white noise their variance is 20 times that of the noise.
double noise_of(const std::vector<double>& x) {
  if (x.size() < 4) return 0;
  std::vector<double> thirds;
  for (std::size_t k = 3; k < x.size(); ++k)
    thirds.push_back(std::abs(x[k] - 3 * x[k - 1] + 3 * x[k - 2] - x[k - 3]));
  return kNormalPerMedian * median(std::move(thirds)) / std::sqrt(20.0);
}

}  // namespace

Sensor sensor_of(std::span<const double> values) {
  const std::vector<double> kept = finite(values);
  if (kept.size() < 2) return {};
  return {resolution_of(kept), noise_of(kept)};
}

}  // namespace crane::diagnosis
