/// crane log: describes, checks, repairs, cuts, merges and exports recordings.
#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <memory>
#include <set>

#include "cli/log_export.hpp"
#include "cli/output_file.hpp"
#include "cli/recording_argument.hpp"
#include "cli/text_table.hpp"
#include "commands.hpp"
#include "crane/recording/loss.hpp"
#include "crane/recording/mcap_edit.hpp"
#include "crane/recording/run_table.hpp"
#include "recording_export/hdf5_export.hpp"
#include "recording_export/matlab_export.hpp"

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

std::string seconds(std::int64_t time_ns, std::int64_t zero_ns) {
  return fixed(static_cast<double>(time_ns - zero_ns) * 1e-9, 3) + " s";
}

/// Samples that the recorder did not record: topic, number, cause, times since the first sample.
void print_losses(const std::vector<recording::Loss>& losses, std::int64_t zero_ns) {
  for (const auto& loss : losses)
    std::cout << "missing: " << loss.topic << ": " << loss.samples
              << (loss.samples == 1 ? " sample " : " samples ") << recording::to_string(loss.cause)
              << ", between " << seconds(loss.from_ns, zero_ns) << " and " << seconds(loss.until_ns, zero_ns)
              << '\n';
}

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
  print_once(lines);  // parts repeat them
  note_other_version(recording);
  print_problems(recording.problems());
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

/// Writes a file of a binary format. @param extension  of the default name
int export_file(const LogOptions& options, const char* extension,
                void (*write)(const std::filesystem::path&, McapReader&, const std::string&)) {
  McapReader recording{options.file};
  note_other_version(recording);
  auto out = options.out;
  if (out.empty()) out = std::filesystem::path{options.file}.replace_extension(extension);
  require_new(out, options.force);
  write(out, recording, options.topic.empty() ? "" : recorded_topic(recording, options.topic));
  std::cout << out.string() << ": written, "
            << fixed(static_cast<double>(std::filesystem::file_size(out)) / 1e6, 2) << " MB\n";
  print_problems(recording.problems());
  return runtime::kExitDone;
}

int export_hdf5(const LogOptions& options) {
  return export_file(options, ".h5", recording_export::write_hdf5);
}

int export_matlab(const LogOptions& options) {
  return export_file(options, ".mat", recording_export::write_matlab);
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
  command->add_option("FILE", options->file, "recording (.mcap)")->required()->check(existing_recording());
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
  constexpr int kFewest = 2, kMost = 1000;
  command->add_option("FILES", options->files, "recordings (.mcap), then the recording to write")
      ->required()
      ->expected(kFewest, kMost);
  add_force(command, options);
  command->footer(
      "Example: crane log merge first.mcap second.mcap both.mcap\n"
      "         crane log merge run.mcap joined.mcap        (run.mcap: the name of a split recording)\n"
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
  auto* hdf5 =
      add(*command, chosen, options, export_hdf5, "hdf5", "Write every topic as a group of datasets (HDF5)");
  hdf5->footer(
      "Example: crane log export hdf5 run.mcap\n"
      "One group per topic (/crane/state), one dataset per field, units and names of enumerators as\n"
      "attributes, metadata and rig file as attributes of the root (docs/data.md).");
  auto* matlab = add(*command, chosen, options, export_matlab, "matlab",
                     "Write every topic as a structure (MAT-file of level 5)");
  matlab->footer(
      "Example: crane log export matlab run.mcap --topic state --out state.mat\n"
      "MATLAB, GNU Octave and SciPy read the file. One structure per topic (crane_state), at most 2 GiB\n"
      "each, one member per field (docs/data.md).");
  for (auto* format : {csv, json, hdf5, matlab}) {
    format->add_option("--topic", options->topic, "only this topic");
    const bool text = format == csv || format == json;
    format->add_option(
        "--out", options->out,
        text ? "file to write; default: standard output" : "file to write; default: FILE with .h5 or .mat");
    add_force(format, options);
  }
}

}  // namespace

void add_log(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<LogOptions>();
  auto* log = app.add_subcommand("log", "Inspect, check, repair, cut, merge and export recordings");
  log->footer(
      "Example: crane log info run.mcap\n"
      "FILE may be the name of a split recording (crane record --split-size): its parts are read as one.\n"
      "docs/data.md describes the recordings.");
  auto* described = add(*log, chosen, options, info, "info", "Show topics, counts, times and metadata");
  described->add_flag("--json", options->json, "one JSON object");
  described->footer("Example: crane log info run.mcap");
  auto* checked = add(*log, chosen, options, check, "check", "Read the whole file and verify every CRC");
  checked->add_flag("--json", options->json, "one JSON object");
  checked->footer(
      "Example: crane log check run.mcap\nExit code 1 when anything is damaged.\n"
      "Samples that the recorder did not receive or had to drop are listed as missing.");
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
