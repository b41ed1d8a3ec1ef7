/// crane replay: runs the installed programs on the recorded inputs, and compares every sample.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands/log.hpp"
#include "cli/output_file.hpp"
#include "cli/recording_argument.hpp"
#include "cli/text_table.hpp"
#include "commands.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/recording/parts.hpp"
#include "replay/replay.hpp"
#include "replay/swap.hpp"
#include "stack/launch.hpp"

namespace crane::cli {
namespace {

struct ReplayOptions {
  std::filesystem::path file, out;
  std::string swap;
  bool json = false, force = false, processes = false;
  std::string vendor = "cyclone";
  std::vector<std::string> vendors;
  std::uint32_t domain = 0;
};

nlohmann::ordered_json to_json(const replay::Result& found) {
  nlohmann::ordered_json json{
      {"equal", !found.first}, {"equal_ticks", found.equal_ticks}, {"recording", found.origin}};
  if (found.first)
    json["first_difference"] = {{"tick", found.first->tick},
                                {"time_s", found.first->time_s},
                                {"topic", found.first->topic},
                                {"field", found.first->what.field},
                                {"recorded", found.first->what.recorded},
                                {"replayed", found.first->what.replayed}};
  if (!found.ends.empty()) json["ends"] = found.ends;
  json["assumed_ticks"] = found.assumed_ticks;
  json["not_recorded_samples"] = found.not_recorded;
  json["irregular_ticks"] = found.irregular_ticks;
  json["skipped_ticks"] = found.skipped_ticks;
  json["steps_without_state"] = found.steps_without_state;
  json["decided_by_outputs"] = found.decided_by_outputs;
  json["problems"] = found.problems;
  return json;
}

replay::Result result_of(const ReplayOptions& options) {
  if (!options.processes) return replay::replay(options.file, replay::loop_components());
  replay::ProcessOptions processes;
  processes.bus.vendor = options.vendor;
  processes.bus.domain = options.domain;
  processes.vendors = stack::vendors_from(options.vendors, replay::loop_components());
  return replay::replay_in_processes(options.file, processes);
}

/// Prints the samples and ticks that the replay did not compare, and the reasons.
void print_remarks(const replay::Result& found) {
  print_log_problems(found.problems);
  if (!found.problems.empty())
    std::cerr << "the recording is damaged: the replay ends after tick " << found.equal_ticks - 1 << '\n';
  if (!found.ends.empty()) std::cerr << "the replay ends before " << found.ends << '\n';
  if (found.assumed_ticks > 0)
    std::cerr << "the first " << found.assumed_ticks
              << " ticks are not in the recording: the replay assumes that the crane rested as in the first "
                 "recorded tick\n";
  if (found.not_recorded > 0)
    std::cerr << found.not_recorded << " samples are not in the recording and were not compared\n";
  if (found.irregular_ticks > 0)
    std::cerr << found.irregular_ticks
              << " ticks had a late process and were replayed with the recorded inputs; in "
              << found.steps_without_state << " steps the supervisor had no state; in "
              << found.decided_by_outputs
              << " ticks the recorded outputs determined whether a component had an input\n";
  if (found.skipped_ticks > 0) std::cerr << "the bridge skipped " << found.skipped_ticks << " ticks\n";
}

int compare(const ReplayOptions& options) {
  const auto found = result_of(options);
  const auto ticks = std::to_string(found.equal_ticks) + " ticks";
  if (options.json)
    std::cout << to_json(found).dump(2) << '\n';
  else if (!found.first)
    std::cout << "equal bit for bit, " << ticks << '\n';
  else
    std::cout << "equal bit for bit for " << ticks << ", then different: " << replay::sentence(*found.first)
              << '\n';
  print_remarks(found);
  return found.first ? runtime::kExitFailed : runtime::kExitDone;
}

nlohmann::ordered_json to_json(const replay::SwapResult& found) {
  nlohmann::ordered_json json{{"recorded", found.recorded}, {"other", found.other}, {"ticks", found.ticks}};
  json["first_different_tick"] =
      found.first_differs ? nlohmann::json(*found.first_differs) : nlohmann::json();
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    const auto& largest = found.largest[i];
    json["largest"][plant::kCoordinates[i].name] = {{"difference_v", largest.difference_v},
                                                    {"tick", largest.tick},
                                                    {"time_s", largest.time_s},
                                                    {"recorded_v", largest.recorded_v},
                                                    {"other_v", largest.other_v}};
  }
  json["problems"] = found.problems;
  return json;
}

void print(const replay::SwapResult& found) {
  if (!found.first_differs) {
    std::cout << found.other << " and " << found.recorded << ": equal demands in all " << found.ticks
              << " ticks, bit for bit\n";
    return;
  }
  std::cout << found.other << " instead of " << found.recorded << ": " << found.ticks
            << " ticks; the demands differ from tick " << *found.first_differs << '\n';
  TextTable table{
      {"axis", "largest difference [V]", "at [s]", "tick", found.recorded + " [V]", found.other + " [V]"}};
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    const auto& largest = found.largest[i];
    if (largest.difference_v > 0)
      table.add({plant::kCoordinates[i].name, fixed(largest.difference_v, 3), fixed(largest.time_s, 2),
                 std::to_string(largest.tick), fixed(largest.recorded_v, 3), fixed(largest.other_v, 3)});
    else
      table.add({plant::kCoordinates[i].name, "0", "", "", "", ""});
  }
  table.print(std::cout);
}

/// @return NAME of "controller=NAME"
std::string controller_of(const std::string& swap) {
  constexpr std::string_view kKey = "controller=";
  if (!swap.starts_with(kKey))
    throw configuration::ConfigurationError({"--swap = " + swap + ": must be controller=NAME"});
  return swap.substr(kKey.size());
}

int swap(const ReplayOptions& options) {
  const auto controller = controller_of(options.swap);
  auto out = options.out;
  if (out.empty()) out = std::filesystem::path{options.file}.replace_extension(controller + ".csv");
  configuration::require_other({out}, recording::files_of(options.file));
  require_new(out, options.force);
  const auto found = replay::swap_controller(options.file, controller);
  recording::write_csv(out, found.table);
  if (options.json) {
    std::cout << to_json(found).dump(2) << '\n';
  } else {
    print(found);
    std::cout << "demands of every tick: " << out.string() << '\n';
  }
  print_log_problems(found.problems);
  return runtime::kExitDone;
}

int run(const ReplayOptions& options) {
  spdlog::set_level(spdlog::level::off);  // the replayed components would report the recorded stops again
  try {
    return options.swap.empty() ? compare(options) : swap(options);
  } catch (const recording::ReadError& error) {
    std::cerr << "crane: " << error.what() << '\n';
  } catch (const replay::Refusal& refusal) {
    std::cerr << refusal.what() << '\n';
  }
  return runtime::kExitBadInput;
}

}  // namespace

void add_replay(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<ReplayOptions>();
  auto* command = app.add_subcommand(
      "replay", "Run the installed programs on the recorded inputs, and compare every sample bit for bit");
  command
      ->add_option("FILE", options->file, "recording of crane run, crane record or crane up --record (.mcap)")
      ->required()
      ->check(existing_recording());
  auto* swapped =
      command->add_option("--swap", options->swap,
                          "controller=NAME: compute what this controller would have demanded at the recorded "
                          "states, and write a CSV file");
  command
      ->add_option("--out", options->out,
                   "CSV file of --swap; default: FILE with the extension .NAME.csv instead of .mcap")
      ->needs(swapped);
  auto* processes = command
                        ->add_flag("--processes", options->processes,
                                   "one process for each component, over DDS; default: one process for all")
                        ->excludes(swapped);
  command->add_option("--dds", options->vendor, "DDS vendor of the processes")
      ->check(CLI::IsMember({"cyclone", "fastdds"}))
      ->needs(processes)
      ->capture_default_str();
  command
      ->add_option("--dds-for", options->vendors,
                   "NAME=VENDOR: vendor of one process, for example "
                   "supervisor=fastdds; may be repeated")
      ->needs(processes);
  command->add_option("--domain", options->domain, "DDS domain of the processes")
      ->check(CLI::Range(0, 100))
      ->needs(processes)
      ->capture_default_str();
  command->add_flag("--force", options->force, "overwrite the CSV file")->needs(swapped);
  command->add_flag("--json", options->json, "one JSON object");
  command->footer(
      "Examples: crane replay out/recording.mcap\n"
      "          crane replay run.mcap --processes --dds fastdds\n"
      "          crane replay out/recording.mcap --swap controller=delayed_1\n"
      "Exit code: 0 all samples are equal, 1 a sample differs or is missing (the output names tick, topic, "
      "field\n"
      "and both values), 2 the recording cannot be replayed: it must begin with the start of the stack\n"
      "(docs/data.md).");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace crane::cli
