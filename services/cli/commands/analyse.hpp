#pragma once
/// The subcommands of `crane analyse`, one file each.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/commands/commands.hpp"
#include "crane/analysis/quasi_polynomial.hpp"

namespace crane::cli {

void add_analyse_damping(CLI::App& analyse, Action& chosen);
void add_analyse_gains(CLI::App& analyse, Action& chosen);
void add_analyse_fuzzy(CLI::App& analyse, Action& chosen);
void add_analyse_sensitivity(CLI::App& analyse, Action& chosen);

/// Text of a pole: "-2.871 + 5.994j".
[[nodiscard]] std::string pole_text(analysis::Complex s);
/// JSON of a pole: {"re": ..., "im": ...}.
[[nodiscard]] nlohmann::ordered_json pole_json(analysis::Complex s);

/// Creates the directory. @throws std::runtime_error on failure
void require_directory(const std::filesystem::path& directory);

}  // namespace crane::cli
