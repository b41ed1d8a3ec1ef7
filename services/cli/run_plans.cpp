#include "cli/run_plans.hpp"

#include <map>
#include <set>

#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/experiment/variant.hpp"
#include "stack/data_files.hpp"

namespace crane::cli {
namespace {

Names first_given(const Names& by_user, const Names& by_scenario, const Names& otherwise) {
  return !by_user.empty() ? by_user : !by_scenario.empty() ? by_scenario : otherwise;
}

Names every_controller() {
  Names names;
  for (const auto& controller : control::controllers()) names.emplace_back(controller.name);
  return names;
}

/// Loads the rig of one scenario and adds its runs to `plans`.
void add_plans(const std::string& name, const RunOptions& options,
               std::vector<experiments::PlannedRun>& plans) {
  const auto file = stack::find_scenario(name);
  const auto defaults = experiment::load_scenario(file);
  const auto rig = configuration::load_rig(stack::find_rig(!options.rig.empty()    ? options.rig
                                                           : !defaults.rig.empty() ? defaults.rig
                                                                                   : stack::kDefaultRig));
  const auto scenario = experiment::load_scenario(file, &rig);
  const Names as_it_is{""};
  const auto variants = first_given(options.variants, defaults.variants,
                                    options.compare ? experiment::default_variants() : as_it_is);
  const auto controllers =
      first_given(options.controllers, defaults.controllers, options.compare ? every_controller() : as_it_is);
  for (const auto& variant : variants) {
    (void)experiment::changed_by(rig, variant);  // reports unknown variants before the first run
    for (const auto& controller : controllers)
      plans.push_back({scenario, rig, &runtime::chosen_controller(controller, rig), variant,
                       simulator::method_named(options.integrator)});
  }
}

}  // namespace

std::vector<experiments::PlannedRun> plans_of(const RunOptions& options) {
  std::vector<experiments::PlannedRun> plans;
  if (options.scenarios.empty() && !options.compare)
    throw configuration::ConfigurationError(
        {"scenario: give at least one, or --compare, which runs maneuver_1, maneuver_2 and maneuver_3"});
  const Names maneuvers(stack::kManeuvers.begin(), stack::kManeuvers.end());
  for (const auto& name : options.scenarios.empty() ? maneuvers : options.scenarios)
    add_plans(name, options, plans);
  return plans;
}

std::string directory_name(const RunOptions& options, const experiments::PlannedRun& plan) {
  const bool chosen = !options.controllers.empty() || !plan.scenario.controllers.empty();
  return plan.scenario.name + (chosen ? "_" + std::string{plan.controller->name} : "") +
         (plan.variant.empty() ? "" : "_" + plan.variant);
}

void require_own_directories(const RunOptions& options, const std::vector<experiments::PlannedRun>& plans) {
  std::vector<std::string> problems;
  std::map<std::string, std::string> scenarios;
  for (const auto& plan : plans) {
    const auto [other, first] = scenarios.try_emplace(directory_name(options, plan), plan.scenario.path);
    if (!first)
      problems.push_back(plan.scenario.path + ": the results would overwrite those of " + other->second +
                         " in " + (std::filesystem::path{options.out} / other->first).string() +
                         "; run the two scenarios with different --out");
  }
  if (!problems.empty()) throw configuration::ConfigurationError(problems);
}

void require_other(const std::vector<std::filesystem::path>& outputs,
                   const std::vector<experiments::PlannedRun>& plans) {
  std::set<std::filesystem::path> inputs;
  for (const auto& plan : plans) inputs.insert({plan.rig.path, plan.scenario.path});
  configuration::require_other(outputs, configuration::with_base_files({inputs.begin(), inputs.end()}));
}

}  // namespace crane::cli
