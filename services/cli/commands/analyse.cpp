/// crane analyse: analysis of the closed loops, and sensitivity of the results to wrong parameters.
#include "cli/commands/analyse.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <system_error>

#include "cli/text_table.hpp"

namespace crane::cli {

std::string pole_text(analysis::Complex s) {
  if (s.imag() == 0) return fixed(s.real(), 3);
  return fixed(s.real(), 3) + (s.imag() < 0 ? " - " : " + ") + fixed(std::abs(s.imag()), 3) + "j";
}

nlohmann::ordered_json pole_json(analysis::Complex s) { return {{"re", s.real()}, {"im", s.imag()}}; }

void require_directory(const std::filesystem::path& directory) {
  std::error_code failure;
  std::filesystem::create_directories(directory, failure);
  if (failure) throw std::runtime_error(directory.string() + ": " + failure.message());
}

void add_analyse(CLI::App& app, Action& chosen) {
  auto* command = app.add_subcommand(
      "analyse", "Compute poles, damping maps, gain curves, fuzzy rules and sensitivity of the control laws");
  command->footer(R"(Examples:
  crane analyse damping --out out/damping          figures 3.16, 3.17, 3.19 from the exact roots
  crane analyse gains --out out/gains              figures 3.5, 3.6, 3.10
  crane analyse fuzzy                              Table 3.7 compared with the generated rules
  crane analyse sensitivity --scenario maneuver_1 --controller delayed_1 --out out/sensitivity
Figures and tables are those of the dissertation; docs/analysis.md explains them.)");
  add_analyse_damping(*command, chosen);
  add_analyse_gains(*command, chosen);
  add_analyse_fuzzy(*command, chosen);
  add_analyse_sensitivity(*command, chosen);
}

}  // namespace crane::cli
