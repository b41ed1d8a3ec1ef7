#pragma once
/// Encodes the data of a plot as compact JSON for assets/page.js.
#include <nlohmann/json.hpp>
#include <vector>

#include "crane/report/page.hpp"

namespace crane::report {

/// {"e": k, "d": [...]}: value i is (d[0] + ... + d[i]) 10^k; null is a gap. The resolution is at most 1e-5
/// of the range of the values, finer than a pixel.
[[nodiscard]] nlohmann::ordered_json encoded(const std::vector<double>& values);

/// Title, labels, group, the distinct x columns and the series. @throws std::invalid_argument as to_html()
[[nodiscard]] nlohmann::ordered_json to_json(const LinePlot& plot);

}  // namespace crane::report
