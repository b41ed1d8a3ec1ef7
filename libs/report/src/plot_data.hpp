#pragma once
/// The data of a plot as compact JSON for assets/page.js.
#include <nlohmann/json.hpp>
#include <vector>

#include "crane/report/page.hpp"

namespace crane::report {

/// {"e": k, "d": [...]}: value i is the sum of d[0..i] times 10^k; null leaves a gap. Steps are at most
/// 1e-5 of the range of the values, less than a picture shows.
[[nodiscard]] nlohmann::ordered_json encoded(const std::vector<double>& values);

/// Title, labels, group, the distinct x columns and the series. @throws std::invalid_argument as to_html()
[[nodiscard]] nlohmann::ordered_json to_json(const LinePlot& plot);

}  // namespace crane::report
