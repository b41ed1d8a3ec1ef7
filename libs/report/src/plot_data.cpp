#include "plot_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace crane::report {
namespace {

using Json = nlohmann::ordered_json;

/// Largest exponent k for which rounding to 10^k is below 1e-5 of the range and all integers are exact in a
/// double.
int decimal_exponent(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low, largest = 0;
  for (const double value : values)
    if (std::isfinite(value)) {
      low = std::min(low, value);
      high = std::max(high, value);
      largest = std::max(largest, std::abs(value));
    }
  if (!(largest > 0)) return 0;
  constexpr int kDigits = 5, kExactDigits = 15;
  const auto digits = [](double value) { return static_cast<int>(std::floor(std::log10(value))); };
  const int exact = digits(largest) + 1 - kExactDigits;
  return std::clamp(high > low ? std::max(digits(high - low) - kDigits, exact) : exact, -300, 300);
}

[[noreturn]] void refuse(const LinePlot& plot, const Series& series, const std::string& what) {
  throw std::invalid_argument("plot \"" + plot.title + "\", series \"" + series.name + "\": " + what);
}

void check(const LinePlot& plot, const Series& series, const std::vector<double>& x) {
  if (series.y.size() != x.size())
    refuse(plot, series, std::to_string(series.y.size()) + " y for " + std::to_string(x.size()) + " x");
  if (series.upper.size() != (series.style == Style::band ? x.size() : 0))
    refuse(plot, series, "a band must have as many upper values as x; other styles have no upper values");
  if (!std::all_of(x.begin(), x.end(), [](double value) { return std::isfinite(value); }))
    refuse(plot, series, "x is not finite");
  if (series.style != Style::points && !std::is_sorted(x.begin(), x.end()))
    refuse(plot, series, "x decreases");
}

std::vector<double> picked(const std::vector<double>& values, const std::vector<std::size_t>& order) {
  std::vector<double> result;
  for (const std::size_t i : order) result.push_back(values[i]);
  return result;
}

const char* name_of(Style style) {
  switch (style) {
    case Style::line:
      return "line";
    case Style::points:
      return "points";
    case Style::band:
      return "band";
  }
  return "line";
}

/// Index of `x` in `columns`; a new `x` is appended.
std::size_t column_of(const std::vector<double>& x, std::vector<std::vector<double>>& columns) {
  const auto found = std::find(columns.begin(), columns.end(), x);
  if (found != columns.end()) return static_cast<std::size_t>(found - columns.begin());
  columns.push_back(x);
  return columns.size() - 1;
}

}  // namespace

Json encoded(const std::vector<double>& values) {
  const int exponent = decimal_exponent(values);
  const long double scale = std::pow(10.0L, exponent);
  auto steps = Json::array();
  std::int64_t sum = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) {
      steps.push_back(nullptr);
      continue;
    }
    const std::int64_t rounded = std::llround(static_cast<long double>(value) / scale);
    steps.push_back(rounded - sum);
    sum = rounded;
  }
  return {{"e", exponent}, {"d", std::move(steps)}};
}

Json to_json(const LinePlot& plot) {
  std::vector<std::vector<double>> columns;
  auto series_json = Json::array();
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& series = plot.series[i];
    const std::vector<double>& x = series.x.empty() ? plot.x : series.x;
    check(plot, series, x);
    // Points may have any order; uPlot requires sorted x.
    std::vector<std::size_t> order(x.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&x](std::size_t a, std::size_t b) { return x[a] < x[b]; });
    Json json{{"name", series.name},
              {"style", name_of(series.style)},
              {"color", series.color < 0 ? static_cast<int>(i) : series.color},
              {"x", column_of(picked(x, order), columns)},
              {"y", encoded(picked(series.y, order))}};
    if (series.style == Style::band) json["upper"] = encoded(picked(series.upper, order));
    if (series.dashed) json["dashed"] = true;
    if (!series.shown) json["hidden"] = true;
    series_json.push_back(std::move(json));
  }
  auto xs = Json::array();
  for (const auto& column : columns) xs.push_back(encoded(column));
  return {{"xLabel", plot.x_label},
          {"yLabel", plot.y_label},
          {"group", plot.group},
          {"xs", std::move(xs)},
          {"series", std::move(series_json)}};
}

}  // namespace crane::report
