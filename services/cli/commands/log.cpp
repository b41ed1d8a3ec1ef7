/// crane log: describes, checks, repairs, cuts, merges and exports recordings.
#include <iostream>
#include <memory>
#include <set>

#include "cli/commands/log.hpp"
#include "cli/log_export.hpp"
#include "cli/number_range.hpp"
#include "cli/output_file.hpp"
#include "cli/recording_argument.hpp"
#include "cli/text_table.hpp"
#include "crane/recording/loss.hpp"
#include "crane/recording/run_table.hpp"

namespace crane::cli {
namespace {

using recording::McapReader;

std::string seconds(std::int64_t time_ns, std::int64_t zero_ns) {
  return fixed(static_cast<double>(time_ns - zero_ns) * 1e-9, 3) + " s";
}

/// Prints the samples that the recorder did not record: topic, number, cause, times since the first sample.
void print_losses(const std::vector<recording::Loss>& losses, std::int64_t zero_ns) {
  for (const auto& loss : losses)
    std::cout << "missing: " << loss.topic << ": " << loss.samples
              << (loss.samples == 1 ? " sample " : " samples ") << recording::to_string(loss.cause)
              << ", between " << seconds(loss.from_ns, zero_ns) << " and " << seconds(loss.until_ns, zero_ns)
              << '\n';
}

void print_once(const std::vector<std::string>& lines) {
  std::set<std::string> printed;
  for (const auto& line : lines)
    if (printed.insert(line).second) std::cout << line << '\n';
}

int info(const LogOptions& options) {
  McapReader recording{options.file};
  const auto found = describe(recording, options.file);
  if (options.json) {
    std::cout << found.dump(2) << '\n';
    return runtime::kExitDone;
  }
  const auto files = found["files"].size();
  std::cout << options.file.string() << ": " << found["messages"] << " samples, "
            << fixed(found["bytes"].get<double>() / 1e6, 2) << " MB, "
            << fixed(found["duration_s"].get<double>(), 3) << " s, "
            << (files > 1 ? std::to_string(files) + " parts, " : "")
            << (recording.indexed() ? "closed correctly" : "not closed correctly (crane log repair)") << '\n';
  const bool accounted = found.contains("losses");
  TextTable table{accounted ? std::vector<std::string>{"topic", "type", "samples", "missing"}
                            : std::vector<std::string>{"topic", "type", "samples"}};
  for (const auto& topic : found["topics"]) {
    std::vector<std::string> row{topic["topic"], topic["type"], topic["messages"].dump()};
    if (accounted) row.push_back(topic["missing"].dump());
    table.add(row);
  }
  table.print(std::cout);
  print_losses(recording::losses_in(recording), recording.first_time_ns());
  std::vector<std::string> lines;
  for (const auto& record : found["metadata"])
    for (const auto& [key, value] : record["entries"].items())
      lines.push_back(record["name"].get<std::string>() + '.' + key + " = " + value.get<std::string>());
  for (const auto& attachment : found["attachments"])
    lines.push_back("attachment " + attachment["name"].get<std::string>() + ", " +
                    attachment["bytes"].dump() + " bytes");
  print_once(lines);  // every part of a recording contains them
  note_other_version(recording);
  print_log_problems(recording.problems());
  return runtime::kExitDone;
}

int check(const LogOptions& options) {
  const auto found = recording::check(options.file);
  McapReader recording{options.file};
  const auto losses = recording::losses_in(recording);
  if (options.json) {
    nlohmann::ordered_json report{{"messages", found.messages}, {"problems", found.problems}};
    if (recording::has_losses_channel(recording)) report["losses"] = losses_json(losses);
    std::cout << report.dump(2) << '\n';
  } else {
    std::cout << options.file.string() << ": " << found.messages << " samples readable, "
              << (found.problems.empty() ? "intact" : "damaged (crane log repair)")
              << (recording::has_losses_channel(recording) && losses.empty() ? ", none reported missing" : "")
              << '\n';
    print_losses(losses, recording.first_time_ns());
  }
  print_log_problems(found.problems);
  return found.problems.empty() ? runtime::kExitDone : runtime::kExitFailed;
}

void print_copied(const std::filesystem::path& out, const recording::CheckReport& found) {
  std::cout << out.string() << ": " << found.messages << " samples saved\n";
  print_log_problems(found.problems);
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

void add_cut(CLI::App& log, Action& chosen, const SharedLogOptions& options) {
  auto* command =
      add_log_command(log, chosen, options, cut, "cut", "Copy a range of time to a new recording");
  command->add_option("OUT", options->out, "recording to write")->required();
  command->add_option("--from", options->range.from_s, "first time, in s from the first sample; default: 0")
      ->check(not_negative_number());
  command
      ->add_option(
          "--to", options->range.until_s,
          "end, in s from the first sample; a sample at this time is not copied; default: the end of "
          "the recording")
      ->check(positive_number());
  add_log_force(command, options);
  command->footer("Example: crane log cut run.mcap --from 12.5 --to 20 stop.mcap");
}

void add_merge(CLI::App& log, Action& chosen, const SharedLogOptions& options) {
  auto* command =
      log.add_subcommand("merge", "Merge recordings into a new recording, in the order of log time");
  constexpr int kFewest = 2, kMost = 1000;
  command->add_option("FILES", options->files, "recordings (.mcap), then the recording to write")
      ->required()
      ->expected(kFewest, kMost);
  add_log_force(command, options);
  command->footer(
      "Example: crane log merge first.mcap second.mcap both.mcap\n"
      "         crane log merge run.mcap joined.mcap        (run.mcap: the name of a split recording)\n"
      "The command refuses recordings with different schemas or rig files.");
  command->callback([options, &chosen] { chosen = [options] { return run_log_action(merge, *options); }; });
}

}  // namespace

void note_other_version(const McapReader& recording) {
  const auto version = recording::messages_version(recording);
  const auto difference = recording::version_difference(version);
  if (version && !difference.empty())
    std::cerr << "the recording has " << difference << ": fields and units are those of the recording\n";
}

void print_log_problems(const std::vector<std::string>& problems) {
  for (const auto& problem : problems) std::cerr << problem << '\n';
}

int run_log_action(LogAction action, const LogOptions& options) {
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

CLI::App* add_log_command(CLI::App& log, Action& chosen, const SharedLogOptions& options, LogAction action,
                          const char* name, const char* summary) {
  auto* command = log.add_subcommand(name, summary);
  command->add_option("FILE", options->file, "recording (.mcap)")->required()->check(existing_recording());
  command->callback([options, action, &chosen] {
    chosen = [options, action] { return run_log_action(action, *options); };
  });
  return command;
}

void add_log_force(CLI::App* command, const SharedLogOptions& options) {
  command->add_flag("--force", options->force, "overwrite an existing file");
}

void add_log(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<LogOptions>();
  auto* log = app.add_subcommand("log", "Inspect, check, repair, cut, merge and export recordings");
  log->footer(
      "Example: crane log info run.mcap\n"
      "FILE may be the name of a split recording (crane record --split-size): its parts are read as one.\n"
      "docs/data.md describes the recordings.");
  auto* described =
      add_log_command(*log, chosen, options, info, "info", "Show topics, counts, times and metadata");
  described->add_flag("--json", options->json, "one JSON object");
  described->footer("Example: crane log info run.mcap");
  auto* checked =
      add_log_command(*log, chosen, options, check, "check", "Read the whole file and verify every CRC");
  checked->add_flag("--json", options->json, "one JSON object");
  checked->footer(
      "Example: crane log check run.mcap\nExit code 1: the recording is damaged.\n"
      "Samples that the recorder did not receive or had to drop are listed as missing.");
  auto* repaired = add_log_command(*log, chosen, options, repair, "repair",
                                   "Copy the readable part of a damaged recording to a new file");
  repaired->add_option("--out", options->out, "file to write; default: FILE with .repaired.mcap");
  repaired->footer("Example: crane log repair run.mcap --out saved.mcap");
  add_log_force(repaired, options);
  add_cut(*log, chosen, options);
  add_merge(*log, chosen, options);
  add_log_export(*log, chosen, options);
}

}  // namespace crane::cli
