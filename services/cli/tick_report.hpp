#pragma once
/// Report of `crane bench tick`: tables and JSON.
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "cli/floors.hpp"
#include "cli/processor_time.hpp"
#include "cli/tick_breakdown.hpp"

namespace crane::cli {

/// Result of one run.
struct TickBench {
  std::vector<runtime::ComponentSpec> processes;
  double period_s = 0;
  int priority = 0;
  std::vector<Floor> floors;
  std::vector<ProcessShare> processor;
  TickBreakdown breakdown;
};

[[nodiscard]] nlohmann::ordered_json json_of(const TickBench& bench);
void print(const TickBench& bench, std::ostream& out);

}  // namespace crane::cli
