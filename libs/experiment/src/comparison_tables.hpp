#pragma once
/// What the Markdown and the HTML of a comparison have in common.
#include <map>
#include <string>
#include <vector>

#include "crane/experiment/comparison.hpp"

namespace crane::experiment {

/// "as the rig file says" for no variant.
[[nodiscard]] std::string variant_title(const std::string& variant);
/// The summaries of a variant's parts.
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
/// Settling times: controllers down, variants across; "-" where it never settled, "OVERSPEED" where it was
/// stopped.
[[nodiscard]] TextTable settling_table(std::span<const ComparedRun> runs, const std::string& scenario);
/// One row per run, one column per figure, the last saying why a run was stopped.
[[nodiscard]] TextTable figures_table(const std::vector<const ComparedRun*>& runs);

}  // namespace crane::experiment
