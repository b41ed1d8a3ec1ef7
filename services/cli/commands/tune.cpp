/// crane tune: identifies an unknown rig by safe motion, and recommends a law with its gains.
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands/commands.hpp"
#include "cli/plant_option.hpp"
#include "cli/text_table.hpp"
#include "crane/workers/process_pool.hpp"
#include "stack/data_files.hpp"
#include "stack/launch.hpp"
#include "tuning/lockstep_crane.hpp"
#include "tuning/realtime_crane.hpp"
#include "tuning/tune.hpp"

namespace crane::cli {
namespace {

struct TuneCommand {
  std::string rig = stack::kDefaultRig, hidden, out = "out/tune", clock = "lockstep";
  stack::Plant plant = stack::Plant::simulated;
  bool json = false, identify_only = false;
  std::uint64_t seed = 1;
  runtime::BusOptions bus;
  std::vector<std::string> vendors;
};

std::string seconds_or_dash(const std::optional<double>& value) { return value ? fixed(*value, 2) : "-"; }

void print_ranking(const tuning::Recommendation& recommendation) {
  constexpr std::size_t kShown = 12;
  TextTable table{{"law", "mean settle [s]", "delay margin [periods]", "gain margin", "changed [s]",
                   "predicted [s]", ""}};
  const std::size_t winner = recommendation.winner.value_or(0);
  for (std::size_t i = 0; i < recommendation.entries.size() && i < std::max(kShown, winner + 1); ++i) {
    const auto& entry = recommendation.entries[i];
    std::vector<std::string> row{entry.candidate.label(), seconds_or_dash(entry.mean_settling_s)};
    if (entry.margins) {
      row.push_back(fixed(entry.margins->delay_periods, 0));
      row.push_back(fixed(entry.margins->gain, 1));
      row.push_back(entry.margins->survives_changes ? seconds_or_dash(entry.margins->changed_settling_s)
                                                    : "unstable");
      row.push_back(!entry.margins->holds() ? ""
                    : entry.predicted       ? fixed(entry.predicted->mean_s, 2)
                                            : "does not settle");
      row.emplace_back(i == winner ? "recommended" : "");
    }
    table.add(row);
  }
  std::cout << '\n';
  table.print(std::cout);
}

void print(const tuning::TuneResult& result, const std::filesystem::path& directory) {
  TextTable values{{"parameter", "value", "standard error", "unit"}};
  for (const auto& [name, unit, value] : tuning::named_values(result.identification.values))
    values.add({name, fixed(value.value, 4), fixed(value.standard_error, 4), unit});
  values.print(std::cout);
  if (result.recommendation.winner) print_ranking(result.recommendation);
  std::cout << '\n' << fixed(result.motion_s, 0) << " s of motion";
  for (const char* file : {tuning::kRigFile, tuning::kPageFile, tuning::kJsonFile, tuning::kMotionFile})
    std::cout << ", " << (directory / file).string();
  std::cout << '\n';
}

std::unique_ptr<tuning::CraneAccess> access_to_crane(const TuneCommand& command,
                                                     const configuration::Rig& rig) {
  if (command.clock == "lockstep") {
    if (command.plant == stack::Plant::hardware)
      throw configuration::ConfigurationError({"--plant hardware: a real crane needs --clock realtime"});
    if (command.hidden.empty()) return std::make_unique<tuning::LockstepCrane>(rig);
    auto truth = configuration::load_rig(stack::find_rig(command.hidden));
    if (auto problems = tuning::exchanged_channels(truth, rig); !problems.empty())
      throw configuration::ConfigurationError(std::move(problems));
    return std::make_unique<tuning::LockstepCrane>(std::move(truth));
  }
  if (!command.hidden.empty())
    throw configuration::ConfigurationError({"--hidden: only with --clock lockstep"});
  std::filesystem::create_directories(command.out);
  return std::make_unique<tuning::RealtimeCrane>(tuning::RealtimeOptions{
      .directory = command.out,
      .plant = command.plant,
      .bus = command.bus,
      .vendors = stack::vendors_from(command.vendors, stack::stack_with(command.plant))});
}

int run(const TuneCommand& command) {
  runtime::install_stop_signals();
  spdlog::set_level(spdlog::level::off);  // the supervisor's messages about unstable candidates
  const auto rig = configuration::load_rig(stack::find_rig(command.rig));
  const auto crane = access_to_crane(command, rig);
  tuning::TuneOptions options{.directory = command.out,
                              .processors = workers::processors(),
                              .recommend = !command.identify_only,
                              .seed = command.seed};
  if (!command.hidden.empty()) options.inputs.push_back(stack::find_rig(command.hidden));
  for (const char* name : stack::kManeuvers) options.maneuvers.push_back(stack::find_scenario(name));
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  if (terminal)
    options.progress = [](const std::string& text) { std::cerr << "\r\033[K" << text << std::flush; };
  const auto result = tuning::tune(rig, *crane, options);
  if (terminal) std::cerr << "\r\033[K";
  for (const auto& difference : result.differences) std::cerr << "warning: " << difference << '\n';
  if (const auto text = crane->difference_from_start(rig); !text.empty())
    std::cerr << "warning: " << text << '\n';
  if (command.json)
    std::cout << tuning::to_json(result, rig).dump(2) << '\n';
  else
    print(result, options.directory);
  return runtime::kExitDone;
}

}  // namespace

void add_tune(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<TuneCommand>();
  auto* command = app.add_subcommand(
      "tune", "Identify an unknown rig by safe motion and recommend a control law with its gains");
  command->add_option("--rig", options->rig, "rig file or name: geometry, inertias, encoders, limits")
      ->capture_default_str();
  command->add_option("--hidden", options->hidden,
                      "rig file or name of the crane that is simulated in lockstep; default: --rig");
  command->add_option("--out", options->out, "directory for tuned.toml, tune.html, tune.json, motion.csv")
      ->capture_default_str();
  command
      ->add_option("--clock", options->clock,
                   "lockstep: simulated time; realtime: up to three minutes of motion")
      ->check(CLI::IsMember({"lockstep", "realtime"}))
      ->capture_default_str();
  add_plant_option(*command, options->plant, ", with --clock realtime");
  command->add_flag("--identify-only", options->identify_only,
                    "identify the rig; keep law and gains of the rig file");
  command->add_option("--seed", options->seed, "seed of the rigs that are drawn from the standard errors")
      ->capture_default_str();
  command->add_flag("--json", options->json, "print tune.json");
  command->add_option("--dds-for", options->vendors,
                      "NAME=VENDOR: DDS implementation of one process (repeatable)");
  runtime::add_bus_options(*command, options->bus);
  command->footer(
      "Example: crane tune --rig virginia_tech_tower --hidden my_crane.toml --out out/tune\n"
      "         crane run maneuver_3 --rig out/tune/tuned.toml\n"
      "docs/tune.md explains the motion, the priors and the required margins.");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace crane::cli
