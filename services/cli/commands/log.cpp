/// crane log: describes, checks, repairs, cuts, merges and exports recordings.
#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <memory>

#include "cli/log_export.hpp"
#include "cli/output_file.hpp"
#include "cli/text_table.hpp"
#include "commands.hpp"
#include "crane/recording/mcap_edit.hpp"
#include "crane/recording/run_table.hpp"

namespace crane::cli {
namespace {

using recording::McapReader;

struct LogOptions {
  std::filesystem::path file, out;
  std::vector<std::filesystem::path> files;  ///< of merge: the recordings, then the new file
  recording::TimeRange range;
  std::string topic;
  bool json = false, force = false;
};
using Shared = std::shared_ptr<LogOptions>;

/// Topics are decoded with the types that the recording contains.
void note_other_version(const McapReader& recording) {
  const auto version = recording::messages_version(recording);
  if (version.value_or(crane_MESSAGES_VERSION) != crane_MESSAGES_VERSION)
    std::cerr << "the recording has messages of version " << *version << ", this program has version "
              << crane_MESSAGES_VERSION << ": fields and units are those of the recording\n";
}

void print_problems(const std::vector<std::string>& problems) {
  for (const auto& problem : problems) std::cerr << problem << '\n';
}

int info(const LogOptions& options) {
  McapReader recording{options.file};
  const auto found = describe(recording, options.file);
  if (options.json) {
    std::cout << found.dump(2) << '\n';
    return runtime::kExitDone;
  }
  std::cout << options.file.string() << ": " << found["messages"] << " samples, "
            << fixed(found["bytes"].get<double>() / 1e6, 2) << " MB, "
            << fixed(found["duration_s"].get<double>(), 3) << " s, "
            << (recording.indexed() ? "closed correctly" : "not closed correctly (crane log repair)") << '\n';
  TextTable table{{"topic", "type", "samples"}};
  for (const auto& topic : found["topics"])
    table.add({topic["topic"], topic["type"], topic["messages"].dump()});
  table.print(std::cout);
  for (const auto& record : found["metadata"])
    for (const auto& [key, value] : record["entries"].items())
      std::cout << record["name"].get<std::string>() << '.' << key << " = " << value.get<std::string>()
                << '\n';
  for (const auto& attachment : found["attachments"])
    std::cout << "attachment " << attachment["name"].get<std::string>() << ", " << attachment["bytes"]
              << " bytes\n";
  note_other_version(recording);
  print_problems(recording.problems());
  return runtime::kExitDone;
}

int check(const LogOptions& options) {
  const auto found = recording::check(options.file);
  if (options.json)
    std::cout << nlohmann::ordered_json{{"messages", found.messages}, {"problems", found.problems}}.dump(2)
              << '\n';
  else
    std::cout << options.file.string() << ": " << found.messages << " samples readable, "
              << (found.problems.empty() ? "intact" : "damaged (crane log repair)") << '\n';
  print_problems(found.problems);
  return found.problems.empty() ? runtime::kExitDone : runtime::kExitFailed;
}

void print_copied(const std::filesystem::path& out, const recording::CheckReport& found) {
  std::cout << out.string() << ": " << found.messages << " samples saved\n";
  print_problems(found.problems);
}

int repair(const LogOptions& options) {
  auto out = options.out;
  if (out.empty()) out = std::filesystem::path{options.file}.replace_extension("repaired.mcap");
  require_new(out, options.force);
  print_copied(out, recording::repair(options.file, out));
  return runtime::kExitDone;
}

int cut(const LogOptions& options) {
  require_new(options.out, options.force);
  print_copied(options.out, recording::cut(options.file, options.range, options.out));
  return runtime::kExitDone;
}

int merge(const LogOptions& options) {
  const auto& out = options.files.back();
  require_new(out, options.force);
  print_copied(out, recording::merge(std::span{options.files}.first(options.files.size() - 1), out));
  return runtime::kExitDone;
}

/// Calls `write` with --out or standard output. @throws std::runtime_error when the file cannot be written
template <class Write>
void to_output(const LogOptions& options, const Write& write) {
  const auto& out = options.out;
  if (out.empty()) return write(std::cout);
  require_new(out, options.force);
  std::ofstream file{out, std::ios::binary};
  if (file) write(file);
  file.close();
  if (!file) throw std::runtime_error(out.string() + ": cannot write: " + std::strerror(errno));
}

int export_csv(const LogOptions& options) {
  McapReader recording{options.file};
  if (!options.topic.empty()) note_other_version(recording);
  to_output(options, [&](std::ostream& out) {
    options.topic.empty() ? recording::write_csv(out, recording::run_table(recording))
                          : write_topic_csv(out, recording, options.topic);
  });
  print_problems(recording.problems());
  return runtime::kExitDone;
}

int export_json(const LogOptions& options) {
  McapReader recording{options.file};
  note_other_version(recording);
  to_output(options, [&](std::ostream& out) { write_json_lines(out, recording, options.topic); });
  print_problems(recording.problems());
  return runtime::kExitDone;
}

/// A file that is not a recording, or that must not be merged with the others, gives the exit code of a wrong
/// argument.
int run(int (*action)(const LogOptions&), const LogOptions& options) {
  try {
    return action(options);
  } catch (const recording::ReadError& error) {
    std::cerr << "crane: " << error.what() << '\n';
    return runtime::kExitBadInput;
  } catch (const recording::EditError& error) {
    std::cerr << error.what() << '\n';
    return runtime::kExitBadInput;
  }
}

CLI::App* add(CLI::App& log, Action& chosen, const Shared& options, int (*action)(const LogOptions&),
              const char* name, const char* summary) {
  auto* command = log.add_subcommand(name, summary);
  command->add_option("FILE", options->file, "recording (.mcap)")->required()->check(CLI::ExistingFile);
  command->callback(
      [options, action, &chosen] { chosen = [options, action] { return run(action, *options); }; });
  return command;
}

void add_force(CLI::App* command, const Shared& options) {
  command->add_flag("--force", options->force, "overwrite an existing file");
}

void add_cut(CLI::App& log, Action& chosen, const Shared& options) {
  auto* command = add(log, chosen, options, cut, "cut", "Copy a range of time to a new recording");
  command->add_option("OUT", options->out, "recording to write")->required();
  command->add_option("--from", options->range.from_s, "first time, in s from the first sample; default: 0")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option(
          "--to", options->range.until_s,
          "end, in s from the first sample; a sample at this time is not copied; default: the end of "
          "the recording")
      ->check(CLI::PositiveNumber);
  add_force(command, options);
  command->footer("Example: crane log cut run.mcap --from 12.5 --to 20 stop.mcap");
}

void add_merge(CLI::App& log, Action& chosen, const Shared& options) {
  auto* command =
      log.add_subcommand("merge", "Merge recordings into a new recording, in the order of log time");
  constexpr int kFewest = 3, kMost = 1000;
  command->add_option("FILES", options->files, "recordings (.mcap), then the recording to write")
      ->required()
      ->expected(kFewest, kMost);
  add_force(command, options);
  command->footer(
      "Example: crane log merge first.mcap second.mcap both.mcap\n"
      "Refuses recordings with different schemas or rig files.");
  command->callback([options, &chosen] { chosen = [options] { return run(merge, *options); }; });
}

void add_export(CLI::App& log, Action& chosen, const Shared& options) {
  auto* command = log.add_subcommand("export", "Write a recording in another format");
  command->footer("Example: crane log export csv run.mcap --out run.csv");
  auto* csv = add(*command, chosen, options, export_csv, "csv",
                  "Write the run as one table, or one topic with all its fields");
  csv->footer(
      "Example: crane log export csv run.mcap --out run.csv\n"
      "Without --topic: canonical columns (time_s, trolley_voltage_v, ...), one row per tick of "
      "crane/state.");
  auto* json =
      add(*command, chosen, options, export_json, "json", "Write one JSON object per sample and line");
  json->footer("Example: crane log export json run.mcap --topic event");
  for (auto* format : {csv, json}) {
    format->add_option("--topic", options->topic, "only this topic");
    format->add_option("--out", options->out, "file to write; default: standard output");
    add_force(format, options);
  }
}

}  // namespace

void add_log(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<LogOptions>();
  auto* log = app.add_subcommand("log", "Inspect, check, repair, cut, merge and export recordings");
  log->footer("Example: crane log info run.mcap\ndocs/data.md describes the recordings.");
  auto* described = add(*log, chosen, options, info, "info", "Show topics, counts, times and metadata");
  described->add_flag("--json", options->json, "one JSON object");
  described->footer("Example: crane log info run.mcap");
  auto* checked = add(*log, chosen, options, check, "check", "Read the whole file and verify every CRC");
  checked->add_flag("--json", options->json, "one JSON object");
  checked->footer("Example: crane log check run.mcap\nExit code 1 when anything is damaged.");
  auto* repaired = add(*log, chosen, options, repair, "repair",
                       "Copy the readable part of a damaged recording to a new file");
  repaired->add_option("--out", options->out, "file to write; default: FILE with .repaired.mcap");
  repaired->footer("Example: crane log repair run.mcap --out saved.mcap");
  add_force(repaired, options);
  add_cut(*log, chosen, options);
  add_merge(*log, chosen, options);
  add_export(*log, chosen, options);
}

}  // namespace crane::cli
