/// crane campaign: faults on simulated cranes in virtual time, judged by invariants.
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>
#include <set>
#include <thread>

#include "campaign/report.hpp"
#include "cli/commands/commands.hpp"
#include "cli/number_range.hpp"

namespace crane::cli {
namespace {

using namespace campaign;

struct CampaignOptions {
  std::vector<int> hazards;
  std::vector<std::string> moments;
  std::optional<std::uint64_t> seed;
  std::uint64_t first_seed = 0, seeds = 12;
  unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
  std::string record, log;
  double fault_free_h = 0;
  bool json = false, list = false;
};

Selection selection_of(const CampaignOptions& options) {
  Selection selection{
      .hazards = options.hazards, .moments = {}, .first_seed = options.first_seed, .seeds = options.seeds};
  for (const int number : options.hazards) {
    const std::string given = "--hazard " + std::to_string(number) + ": ";
    const auto* hazard = find_hazard(number);
    if (hazard == nullptr) throw configuration::ConfigurationError({given + "unknown; see --list"});
    if (hazard->test_bed != TestBed::campaign)
      throw configuration::ConfigurationError({given + hazard->name +
                                               ": the campaign cannot inject it; it is verified by " +
                                               hazard->verified_by});
  }
  for (const auto& name : options.moments) {
    const auto moment = moment_named(name);
    if (!moment) throw configuration::ConfigurationError({"--moment " + name + ": unknown; see --list"});
    selection.moments.push_back(*moment);
  }
  if (options.seed) selection.first_seed = *options.seed, selection.seeds = 1;
  if (selection.first_seed > std::numeric_limits<std::uint64_t>::max() - selection.seeds)
    throw configuration::ConfigurationError({"--first-seed " + std::to_string(selection.first_seed) +
                                             " --seeds " + std::to_string(selection.seeds) +
                                             ": the last seed must be below 2^64 - 1"});
  return selection;
}

/// @throws configuration::ConfigurationError when no run is selected
std::vector<Tuple> tuples_of(const CampaignOptions& options) {
  const auto selection = selection_of(options);
  auto all = tuples(selection);
  if (!all.empty()) return all;
  std::uint64_t every = 1;  // of hazards that run long
  for (const int number : options.hazards) every = std::max(every, find_hazard(number)->every);
  throw configuration::ConfigurationError(
      {"no run: the hazards of --hazard run only with seeds that are "
       "multiples of " +
       std::to_string(every) + "; choose another --seed or more --seeds"});
}

/// @throws std::runtime_error that names the file of --log
[[noreturn]] void refuse_log(const std::string& log) {
  throw std::runtime_error(log + ": cannot write: " + std::strerror(errno));
}

int list() {
  std::cout << "moments:";
  for (std::size_t m = 0; m < kMoments; ++m) std::cout << ' ' << name_of(static_cast<Moment>(m));
  std::cout << "\n\n" << hazard_table();
  return 0;
}

int run_single(const CampaignOptions& options, const Tuple& tuple) {
  const auto recording =
      options.record.empty() ? std::nullopt : std::optional<std::filesystem::path>{options.record};
  const auto result = run_one(tuple, recording);
  std::cout << describe(result) << '\n';
  return result.violations == 0 && !result.crashed ? 0 : 1;
}

/// Reads the log of an earlier campaign, whose runs are not repeated.
std::set<std::string> done_before(const std::string& log, Table& table) {
  std::set<std::string> done;
  std::ifstream in{log};
  for (std::string line; std::getline(in, line);)
    if (const auto result = result_from(line)) {
      done.insert(to_string(result->tuple));
      table.add(*result);
    }
  return done;
}

int run_many(const CampaignOptions& options) {
  auto wanted = tuples_of(options);
  Table table;
  const auto done = options.log.empty() ? std::set<std::string>{} : done_before(options.log, table);
  std::erase_if(wanted, [&](const Tuple& tuple) { return done.contains(to_string(tuple)); });
  std::ofstream log;
  if (!options.log.empty()) {
    log.open(options.log, std::ios::app);
    if (!log) refuse_log(options.log);  // before the first run
  }
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  std::size_t count = 0;
  run_all(wanted, options.jobs, [&](const Result& result) {
    table.add(result);
    if (log.is_open() && !(log << line_of(result) << '\n' << std::flush)) refuse_log(options.log);
    if (terminal && ++count % 100 == 0) std::cerr << "\r" << count << " of " << wanted.size() << " runs";
  });
  if (terminal) std::cerr << "\r";
  std::cout << (options.json ? table.json() : table.text());
  return table.violations() == 0 ? 0 : 1;
}

int run_free(const CampaignOptions& options) {
  const auto found = run_fault_free(options.fault_free_h, options.jobs, options.first_seed);
  std::cout << found.hours << " h of virtual time without a fault (seed " << options.first_seed << "), "
            << found.trips.size() << " false trips\n";
  for (const auto& line : found.trips) std::cout << line;
  std::cout << found.limits.size()
            << " stops that the true state confirms: a move crossed a limit, or a controller did not bring "
               "the crane to rest\n";
  for (const auto& line : found.limits) std::cout << line;
  return found.trips.empty() ? 0 : 1;
}

int run(const CampaignOptions& options) {
  spdlog::set_level(spdlog::level::off);  // the recordings contain the messages of the components
  if (options.list) return list();
  if (options.fault_free_h > 0) return run_free(options);
  const auto all = tuples_of(options);
  if (options.seed && all.size() == 1) return run_single(options, all.front());
  if (!options.record.empty())
    throw configuration::ConfigurationError({"--record needs exactly one --hazard, --moment and --seed"});
  return run_many(options);
}

}  // namespace

void add_campaign(CLI::App& app, Action& chosen) {
  auto* command = app.add_subcommand(
      "campaign", "Inject faults into simulated cranes and check the safety invariants (docs/campaign.md)");
  command->footer(
      "Examples: crane campaign --list\n"
      "          crane campaign --hazard 9 --seeds 10");
  auto options = std::make_shared<CampaignOptions>();
  command->add_option("--hazard", options->hazards, "numbers of the hazards (default: all); see --list");
  command->add_option("--moment", options->moments,
                      "moments at which the fault begins (default: all); see --list");
  command->add_option(
      "--seed", options->seed,
      "run only this seed; with one --hazard and one --moment: print a full description of the run");
  command->add_option("--first-seed", options->first_seed,
                      "first seed; a seed selects rig, controller, move and details of the fault");
  command
      ->add_option("--seeds", options->seeds,
                   "number of seeds; 246 to 270 runs each with all hazards and moments")
      ->check(positive_number());
  command->add_option("--jobs", options->jobs, "number of runs at the same time")->check(positive_number());
  command->add_option("--record", options->record,
                      "write an MCAP recording of the run; needs one --hazard, --moment and --seed");
  command->add_option("--log", options->log,
                      "append a line per run to this file, and skip the runs that it already contains");
  command
      ->add_option("--fault-free", options->fault_free_h,
                   "run this number of hours of virtual time without faults instead, and report false trips")
      ->check(positive_number());
  command->add_flag("--json", options->json, "print the table of results as JSON");
  command->add_flag("--list", options->list, "print moments and hazards");
  command->callback([&chosen, options] { chosen = [options] { return run(*options); }; });
}

}  // namespace crane::cli
