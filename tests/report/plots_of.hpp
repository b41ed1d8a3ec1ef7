#pragma once
/// Decodes the plots of a page, independently of assets/page.js.
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace crane::report {

inline std::vector<nlohmann::json> plots_of(const std::string& html) {
  const std::string begin = "<script type=\"application/json\">";
  std::vector<nlohmann::json> plots;
  for (auto at = html.find(begin); at != std::string::npos; at = html.find(begin, at + 1)) {
    const auto from = at + begin.size();
    plots.push_back(nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from)));
  }
  return plots;
}

inline std::vector<double> decoded(const nlohmann::json& column) {
  std::vector<double> values;
  double sum = 0;
  for (const auto& step : column.at("d")) {
    if (!step.is_null()) sum += step.get<double>();
    values.push_back(step.is_null() ? std::numeric_limits<double>::quiet_NaN()
                                    : sum * std::pow(10.0, column.at("e").get<int>()));
  }
  return values;
}

}  // namespace crane::report
