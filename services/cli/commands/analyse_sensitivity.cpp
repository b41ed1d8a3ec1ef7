/// crane analyse sensitivity: settling time and residual swing with one changed quantity at a time.
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>

#include "cli/commands/analyse.hpp"
#include "cli/sensitivity.hpp"
#include "cli/text_table.hpp"
#include "crane/analysis/damping.hpp"
#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/files/complete_file.hpp"
#include "crane/plant/pendulum.hpp"
#include "crane/runtime/process.hpp"
#include "stack/data_files.hpp"

namespace crane::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRunsFile = "sensitivity.csv";
constexpr const char* kFilterFile = "swing_filter.csv";
constexpr const char* kSensitivityText = "sensitivity.md";

struct SensitivityOptions {
  std::vector<std::string> scenarios{"maneuver_1"};
  std::vector<std::string> controllers{"gain_scheduling_partial",
                                       "gain_scheduling_full",
                                       "anti_swing_pd",
                                       "delayed_1",
                                       "delayed_2",
                                       "fuzzy_printed"};
  std::string rig = stack::kDefaultRig, out = "out/sensitivity";
  bool json = false;
};

/// Delayed laws with a filter on the swing angle, exact roots.
struct FilteredLoop {
  std::string law;
  double ratio = 0;     ///< cut-off over sampling frequency, 0: no filter
  double delay_ms = 0;  ///< low-frequency delay of the filter
  analysis::Damping as_designed;
  analysis::Damping shortened;  ///< damping when the delay of the law is shorter by the delay of the filter
};

std::vector<FilteredLoop> filtered_loops(const configuration::Rig& rig) {
  const auto& design = rig.design;
  const double period = plant::swing_period_s(design.crane.gravity_mps2, design.cable_length_m);
  const analysis::TrackingGains tracking{design.tracking_proportional, design.tracking_derivative};
  const std::pair<std::string_view, analysis::GainPoint> laws[] = {
      {"delayed_1", {design.delayed_1_gain, design.delayed_1_delay}},
      {"delayed_2", {design.delayed_2_gain, design.delayed_2_delay}}};
  std::vector<FilteredLoop> loops;
  for (const auto& [name, gains] : laws)
    for (const double ratio : {0.0, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01}) {
      const double cutoff = 2 * std::numbers::pi * ratio / rig.period_s * period;
      const double delay = ratio > 0 ? filter_delay_s(ratio, rig.period_s) / period : 0;  // load periods
      const auto law = analysis::find_anti_swing(name)->law;
      const analysis::GainPoint less{gains.first, std::max(0.0, gains.second - delay)};
      loops.push_back({std::string{name}, ratio, delay * period * 1e3,
                       damping_of(analysis::characteristic(law, gains, tracking, {cutoff})),
                       damping_of(analysis::characteristic(law, less, tracking, {cutoff}))});
    }
  return loops;
}

void write_filter_markdown(std::ostream& out, const std::vector<FilteredLoop>& loops) {
  out << "## Low-pass on the swing angle, exact roots\n\n"
         "Least damping of the linear loop; its filter is a Butterworth low-pass of order 2 on the swing "
         "angle, "
         "`shortened`: tau minus the delay of the filter.\n\n"
         "| law | cut-off / sampling frequency | filter delay [ms] | dominant | least | dominant, shortened "
         "| "
         "least, shortened |\n|---|--:|--:|--:|--:|--:|--:|\n";
  for (const auto& loop : loops)
    out << "| " << loop.law << " | " << (loop.ratio > 0 ? fixed(loop.ratio, 2) : "none") << " | "
        << fixed(loop.delay_ms, 1) << " | " << fixed(loop.as_designed.dominant, 3) << " | "
        << fixed(loop.as_designed.least, 3) << " | " << fixed(loop.shortened.dominant, 3) << " | "
        << fixed(loop.shortened.least, 3) << " |\n";
}

void write_filter_csv(std::ostream& out, const std::vector<FilteredLoop>& loops) {
  out << "law,cutoff_ratio,filter_delay_s,dominant_damping,least_damping,dominant_damping_shortened,"
         "least_damping_shortened\n";
  for (const auto& loop : loops)
    out << loop.law << ',' << recording::shortest(loop.ratio) << ','
        << recording::shortest(loop.delay_ms * 1e-3) << ',' << recording::shortest(loop.as_designed.dominant)
        << ',' << recording::shortest(loop.as_designed.least) << ','
        << recording::shortest(loop.shortened.dominant) << ',' << recording::shortest(loop.shortened.least)
        << '\n';
}

struct SensitivityPlan {
  std::vector<PerturbedRun> runs;  ///< without results
  std::vector<experiments::PlannedRun> plans;
};

SensitivityPlan plan_of(const SensitivityOptions& options, const configuration::Rig& rig) {
  SensitivityPlan plan;
  for (const auto& name : options.scenarios) {
    const auto scenario = experiment::load_scenario(stack::find_scenario(name), &rig);
    for (const auto& controller : options.controllers) {
      const experiments::PlannedRun as_designed{scenario, rig, &runtime::chosen_controller(controller, rig),
                                                ""};
      for (const auto& perturbation : perturbations(as_designed)) {
        plan.plans.push_back(as_designed);
        perturbation.change(plan.plans.back());
        plan.runs.push_back({perturbation.quantity, perturbation.unit, perturbation.value, {}});
      }
    }
  }
  return plan;
}

void run_all(SensitivityPlan& plan) {
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  auto results = experiments::simulate_all(plan.plans, [&](std::size_t done) {
    if (terminal) std::cerr << '\r' << done << " of " << plan.plans.size() << " runs" << std::flush;
  });
  if (terminal) std::cerr << '\n';
  for (std::size_t i = 0; i < results.size(); ++i) plan.runs[i].run = std::move(results[i]);
}

nlohmann::ordered_json runs_json(const std::vector<PerturbedRun>& runs) {
  auto json = nlohmann::ordered_json::array();
  for (const auto& [quantity, unit, value, run] : runs) {
    nlohmann::ordered_json entry{{"scenario", run.scenario}, {"controller", run.controller},
                                 {"quantity", quantity},     {"unit", unit},
                                 {"value", value},           {"stopped_because", run.stopped_because}};
    if (run.metrics) entry.update(experiment::to_json(*run.metrics));
    json.push_back(entry);
  }
  return json;
}

int analyse_sensitivity(const SensitivityOptions& options) {
  runtime::install_stop_signals();
  spdlog::set_level(spdlog::level::off);  // the table contains the cause of a stop
  const auto rig = configuration::load_rig(stack::find_rig(options.rig));
  auto plan = plan_of(options, rig);
  const fs::path out = options.out;
  std::vector<fs::path> inputs{rig.path};
  for (const auto& name : options.scenarios) inputs.push_back(stack::find_scenario(name));
  configuration::require_other({out / kRunsFile, out / kFilterFile, out / kSensitivityText},
                               configuration::with_base_files(inputs));
  require_directory(out);
  run_all(plan);
  const auto loops = filtered_loops(rig);
  const auto markdown = [&](std::ostream& text) {
    text << "# Sensitivity of " << rig.name << "\n\n";
    write_sensitivity_markdown(text, plan.runs);
    write_filter_markdown(text, loops);
  };
  files::write_file(out / kRunsFile, [&](std::ostream& text) { write_sensitivity_csv(text, plan.runs); });
  files::write_file(out / kFilterFile, [&](std::ostream& text) { write_filter_csv(text, loops); });
  files::write_file(out / kSensitivityText, markdown);
  if (options.json)
    std::cout << runs_json(plan.runs).dump(2) << '\n';
  else
    markdown(std::cout);
  return runtime::kExitDone;
}

}  // namespace

void add_analyse_sensitivity(CLI::App& analyse, Action& chosen) {
  auto options = std::make_shared<SensitivityOptions>();
  auto* command = analyse.add_subcommand(
      "sensitivity",
      "Compute settling time and residual swing over cable, load, friction, delay, filters and gains");
  command->add_option("--scenario", options->scenarios, "scenario file or name (repeatable)")
      ->capture_default_str();
  command->add_option("--controller", options->controllers, "controller (repeatable)")->capture_default_str();
  command->add_option("--rig", options->rig, "rig file or name")->capture_default_str();
  command
      ->add_option("--out", options->out, "directory for sensitivity.csv, sensitivity.md, swing_filter.csv")
      ->capture_default_str();
  command->add_flag("--json", options->json, "print the runs as JSON");
  command->footer(
      "Each run changes one quantity; the controllers keep their nominal values. About 30 runs for each\n"
      "scenario and controller, in this process, without DDS.\n"
      "Example: crane analyse sensitivity --scenario maneuver_1 maneuver_3 --controller delayed_1");
  command->callback([options, &chosen] { chosen = [options] { return analyse_sensitivity(*options); }; });
}

}  // namespace crane::cli
