#pragma once
/// Figures of merit as formatted text, for tables.
#include <array>
#include <string>
#include <vector>

#include "crane/experiment/metrics.hpp"

namespace crane::experiment {

/// `value` with `digits` decimals: "0.25".
[[nodiscard]] std::string fixed(double value, int digits);

inline constexpr std::array kMetricsHeader{"settle [s]",         "trolley overshoot", "slew overshoot",
                                           "swing radial [deg]", "tangential [deg]",  "residual [deg]",
                                           "trolley max [V]",    "slew max [V]",      "lost ticks"};
/// One text per column of kMetricsHeader.
[[nodiscard]] std::vector<std::string> metrics_cells(const Metrics& metrics);

}  // namespace crane::experiment
