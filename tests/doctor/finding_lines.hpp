#pragma once
/// Findings of the doctor as lines of text.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../interop/two_hosts.hpp"
#include "doctor/finding.hpp"

namespace crane::doctor {

/// "code: what: remedy" of each finding.
inline std::vector<std::string> lines(const Findings& findings) {
  std::vector<std::string> all;
  for (const auto& finding : findings)
    all.push_back(finding.code + ": " + finding.what + ": " + finding.remedy);
  return all;
}

/// The same of the output of `crane doctor --json`.
inline std::vector<std::string> lines(const hosts::Answer& answer) {
  Findings findings;
  for (const auto& one : nlohmann::json::parse(answer.output.substr(answer.output.find("[\n"))))
    findings.push_back({Grade::good, one["area"], one["code"], one["what"], one["remedy"]});
  return lines(findings);
}

}  // namespace crane::doctor
