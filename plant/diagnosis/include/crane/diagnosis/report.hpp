#pragma once
/// Files of `crane diagnose`: report.json, report.html, extended.toml, pictures, next_experiment.toml.
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"
#include "crane/report/page.hpp"

namespace crane::diagnosis {

/// report.json; fields in docs/diagnosis.md.
[[nodiscard]] nlohmann::ordered_json to_json(const Diagnosis& diagnosis);

/// Output of `crane diagnose --check --json`.
[[nodiscard]] nlohmann::ordered_json to_json(const Check& check);

/// A rig file that extends `rig` (absolute path) by the terms of the diagnosis.
[[nodiscard]] std::string extended_rig_text(const configuration::Rig& rig, const Diagnosis& diagnosis);

/// @param test the held-out runs of diagnose()
[[nodiscard]] report::Page report_page(const Diagnosis& diagnosis, const configuration::Rig& rig,
                                       const std::vector<Run>& test);

/// Draws overlay_N.svg, one per held-out run, and residual_COLUMN.svg.
/// @param directory must exist. @throws plot::PictureError
void draw_diagnosis(const std::filesystem::path& directory, const Diagnosis& diagnosis,
                    const configuration::Rig& rig, const std::vector<Run>& test);

/// The files of write_report().
inline constexpr std::array kReportFiles{"report.json", "extended.toml", "next_experiment.toml",
                                         "report.html"};

/// Writes report.json, report.html and extended.toml, and next_experiment.toml if the diagnosis proposes an
/// experiment; otherwise removes the next_experiment.toml of an earlier diagnosis.
/// @param directory must exist. @throws files::WriteError
void write_report(const std::filesystem::path& directory, const Diagnosis& diagnosis,
                  const configuration::Rig& rig, const std::vector<Run>& test);

}  // namespace crane::diagnosis
