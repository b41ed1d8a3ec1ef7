#pragma once
/// Tables of a comparison, for Markdown and HTML.
#include <map>
#include <string>
#include <vector>

#include "crane/experiment/comparison.hpp"

namespace crane::experiment {

/// Title of a variant; "as the rig file says" for an empty name.
[[nodiscard]] std::string variant_title(const std::string& variant);
/// Summaries of the parts of a variant.
[[nodiscard]] std::string variant_summary(const std::string& variant);

/// Distinct values of a member, in order of appearance.
[[nodiscard]] std::vector<std::string> distinct(std::span<const ComparedRun> runs,
                                                std::string ComparedRun::*member);
[[nodiscard]] std::vector<const ComparedRun*> runs_of(std::span<const ComparedRun> runs,
                                                      const std::string& scenario,
                                                      const std::string& variant);

struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};
/// Settling times in `unit_s`; rows are controllers, columns are variants. "-": not settled; a cause such as
/// "OVERSPEED": stopped.
[[nodiscard]] TextTable settling_table(std::span<const ComparedRun> runs, const std::string& scenario,
                                       double unit_s = 1);
/// One row per run, one column per figure; the last column has the cause of a stop.
[[nodiscard]] TextTable figures_table(const std::vector<const ComparedRun*>& runs);

}  // namespace crane::experiment
