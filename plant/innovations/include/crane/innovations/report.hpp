#pragma once
/// report.json: the fields of crane::diagnosis, and the table of rules, the leftover laws and the
/// likelihoods.
#include <nlohmann/json.hpp>

#include "crane/innovations/diagnose.hpp"

namespace crane::innovations {

[[nodiscard]] nlohmann::ordered_json to_json(const Result& result);

/// Writes report.json and extended.toml. @throws diagnosis::ReportError
void write_report(const std::filesystem::path& directory, const Result& result, const runtime::Rig& rig);

}  // namespace crane::innovations
