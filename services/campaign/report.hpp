#pragma once
/// Reports of a campaign: one line per run, and a table with one row per hazard.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "campaign/campaign.hpp"

namespace crane::campaign {

/// "FOLLOWING_ERROR", "BRIDGE_LATCHED: encoder_frozen"
[[nodiscard]] std::string to_string(const Reason& reason);
/// Full description of one run.
[[nodiscard]] std::string describe(const Result& result);
/// Converts a run to a line of a log, and back. @return nothing when the line is not a run
[[nodiscard]] std::string line_of(const Result& result);
[[nodiscard]] std::optional<Result> result_from(const std::string& line);

/// The hazards as Markdown, as docs/campaign.md shows them.
[[nodiscard]] std::string hazard_table();

/// Results, one row per hazard.
class Table {
 public:
  void add(const Result& result);
  [[nodiscard]] std::string text() const;
  [[nodiscard]] std::string json() const;
  /// Number of runs that violated an invariant, crashed, or did not reach their moment.
  [[nodiscard]] std::size_t violations() const { return failed_.size(); }

 private:
  struct Line {
    std::size_t runs = 0, failed = 0, stopped = 0, right = 0;
    double detection_ms = -1, bound_ms = 0, zero_volts_ms = -1, braked_ms = -1, beyond = 0;
    std::map<std::string, std::size_t> reasons;
  };
  std::map<int, Line> lines_;
  std::vector<Result> failed_;
};

}  // namespace crane::campaign
