/// crane log export: writes recordings in other formats.
#include "cli/log_export.hpp"

#include <iostream>
#include <stdexcept>

#include "cli/commands/log.hpp"
#include "cli/output_file.hpp"
#include "cli/text_table.hpp"
#include "crane/files/complete_file.hpp"
#include "crane/recording/run_table.hpp"
#include "recording_export/hdf5_export.hpp"
#include "recording_export/matlab_export.hpp"

namespace crane::cli {
namespace {

/// Calls `write` with --out or standard output.
/// @throws files::WriteError when the file cannot be written, or is the recording
template <class Write>
void to_output(const LogOptions& options, const recording::McapReader& recording, const Write& write) {
  const auto& out = options.out;
  if (out.empty()) return write(std::cout);
  require_new(out, options.force);
  files::write_file(out, write, recording.files());
}

int export_csv(const LogOptions& options) {
  recording::McapReader recording{options.file};
  if (!options.topic.empty()) note_other_version(recording);
  to_output(options, recording, [&](std::ostream& out) {
    options.topic.empty() ? recording::write_csv(out, recording::run_table(recording))
                          : write_topic_csv(out, recording, options.topic);
  });
  print_log_problems(recording.problems());
  return runtime::kExitDone;
}

int export_json(const LogOptions& options) {
  recording::McapReader recording{options.file};
  note_other_version(recording);
  to_output(options, recording, [&](std::ostream& out) { write_json_lines(out, recording, options.topic); });
  print_log_problems(recording.problems());
  return runtime::kExitDone;
}

/// Writes a file of a binary format. @param extension  of the default name
int export_file(const LogOptions& options, const char* extension,
                void (*write)(const std::filesystem::path&, recording::McapReader&, const std::string&)) {
  recording::McapReader recording{options.file};
  note_other_version(recording);
  auto out = options.out;
  if (out.empty()) out = std::filesystem::path{options.file}.replace_extension(extension);
  require_new(out, options.force);
  write(out, recording, options.topic.empty() ? "" : recorded_topic(recording, options.topic));
  std::cout << out.string() << ": written, "
            << fixed(static_cast<double>(std::filesystem::file_size(out)) / 1e6, 2) << " MB\n";
  print_log_problems(recording.problems());
  return runtime::kExitDone;
}

int export_hdf5(const LogOptions& options) {
  return export_file(options, ".h5", recording_export::write_hdf5);
}

int export_matlab(const LogOptions& options) {
  return export_file(options, ".mat", recording_export::write_matlab);
}

}  // namespace

void add_log_export(CLI::App& log, Action& chosen, const SharedLogOptions& options) {
  auto* command = log.add_subcommand("export", "Write a recording in another format");
  command->footer("Example: crane log export csv run.mcap --out run.csv");
  auto* csv = add_log_command(*command, chosen, options, export_csv, "csv",
                              "Write the run as one table, or one topic with all its fields");
  csv->footer(
      "Example: crane log export csv run.mcap --out run.csv\n"
      "Without --topic: canonical columns (time_s, trolley_voltage_v, ...), one row per tick of "
      "crane/state.");
  auto* json = add_log_command(*command, chosen, options, export_json, "json",
                               "Write one JSON object per sample and line");
  json->footer("Example: crane log export json run.mcap --topic event");
  auto* hdf5 = add_log_command(*command, chosen, options, export_hdf5, "hdf5",
                               "Write every topic as a group of datasets (HDF5)");
  hdf5->footer(
      "Example: crane log export hdf5 run.mcap\n"
      "One group per topic (/crane/state), one dataset per field, units and names of enumerators as\n"
      "attributes, metadata and rig file as attributes of the root (docs/data.md).");
  auto* matlab = add_log_command(*command, chosen, options, export_matlab, "matlab",
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
    add_log_force(format, options);
  }
}

}  // namespace crane::cli
