/// crane record: records topics of a running crane to an MCAP file.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/number_range.hpp"
#include "cli/output_file.hpp"
#include "cli/recording_argument.hpp"
#include "cli/recording_limits.hpp"
#include "cli/sample_json.hpp"
#include "cli/text_table.hpp"
#include "cli/tool_bus.hpp"
#include "commands.hpp"
#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/configuration/rig.hpp"
#include "recorder/recorder.hpp"
#include "stack/data_files.hpp"

namespace crane::cli {
namespace {

struct RecordOptions {
  recorder::Options recorder;
  LimitOptions limits;
  std::string rig;
  double duration_s = 1e9;
  bool force = false;
  runtime::BusOptions bus = tool_bus();
};

std::string summary(const recorder::Recorder& recorder, double elapsed_s) {
  const auto& thread = recorder.thread();
  auto text = std::to_string(thread.written()) + " samples, " +
              fixed(static_cast<double>(thread.bytes()) / 1e6, 2) + " MB, " + fixed(elapsed_s, 1) + " s";
  if (thread.parts() > 1) text += ", " + std::to_string(thread.parts()) + " parts";
  if (thread.dropped() > 0)
    text += ", " + std::to_string(thread.dropped()) + " dropped" +
            (thread.failure() ? "" : ": the disk is too slow");
  if (thread.lost() > recorder.rejected())
    text += ", " + std::to_string(thread.lost() - recorder.rejected()) + " lost on the bus";
  if (recorder.rejected() > 0) text += ", " + std::to_string(recorder.rejected()) + " rejected: wrong CRC";
  return text;
}

/// Progress in one line of the terminal, and a hint when no sample arrives.
class Progress {
 public:
  explicit Progress(const bus::Options& options) : options_{options} {}

  void show(const recorder::Recorder& recorder, double elapsed_s) {
    constexpr double kHintAfter_s = 3;
    if (!hinted_ && !recorder.heard_others() && elapsed_s > kHintAfter_s) {
      hinted_ = true;
      std::cerr << "crane record: no sample received yet" << where_and_remedy(options_) << '\n';
    }
    if (!terminal_ || elapsed_s < next_s_) return;
    next_s_ = elapsed_s + 0.5;
    std::cerr << '\r' << summary(recorder, elapsed_s) << "   " << std::flush;
  }
  void end() const {
    if (terminal_) std::cerr << '\r';
  }

 private:
  const bus::Options& options_;
  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
  bool hinted_ = false;
  double next_s_ = 0;
};

/// @throws configuration::ConfigurationError when a file exists and --force is not given
void remove_existing_files(const RecordOptions& options) {
  for (const auto& file : existing_files_of(options.recorder.file)) {
    require_new(file, options.force);
    std::error_code ignored;  // the recorder reports a file that it cannot create
    const bool replaced = file == options.recorder.file && !options.recorder.limits.split();
    if (!replaced && std::filesystem::is_regular_file(file, ignored)) std::filesystem::remove(file, ignored);
  }
}

int record(RecordOptions options) {
  options.recorder.limits = limits_of(options.limits);
  if (!options.rig.empty()) {
    const auto rig = stack::find_rig(options.rig);
    (void)configuration::load_rig(rig);  // reports the problems of the file
    configuration::require_other({options.recorder.file}, configuration::with_base_files({rig}));
    options.recorder.rig_text = configuration::file_text(rig);
  }
  remove_existing_files(options);
  auto bus = open_bus(options.bus, crane_SOURCE_RECORDER);
  recorder::Recorder recorder{bus, options.recorder};
  Progress progress{bus.options()};
  const auto begin_ns = runtime::monotonic_ns();
  const auto elapsed_s = [begin_ns] {
    return static_cast<double>(runtime::monotonic_ns() - begin_ns) * 1e-9;
  };
  wait_until(bus, options.duration_s, [&] {
    progress.show(recorder, elapsed_s());
    return !recorder.poll();
  });
  const bool complete = recorder.close();
  progress.end();
  std::cout << options.recorder.file.string() << ": " << summary(recorder, elapsed_s()) << '\n';
  return complete ? runtime::kExitDone : runtime::kExitFailed;
}

}  // namespace

void add_record(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<RecordOptions>();
  auto* command = app.add_subcommand("record", "Record topics into an MCAP file until Ctrl-C");
  command->add_option("FILE", options->recorder.file, "file to create")->required();
  command->add_option("--duration", options->duration_s, "duration in s, from the start of the command")
      ->check(positive_number());
  command
      ->add_option_function<std::vector<std::string>>(
          "--topic",
          [options](const std::vector<std::string>& names) {
            for (const auto& name : names) options->recorder.topics.push_back(&topic_named(name));
          },
          "topic to record (repeatable); default: all")
      ->type_name("TOPIC");
  add_limit_options(*command, options->limits);
  command->add_option("--rig", options->rig,
                      "rig file or name; each file of the recording contains this rig file");
  command->add_flag("--force", options->force, "overwrite FILE and its parts");
  runtime::add_bus_options(*command, options->bus);
  command->footer(
      "Examples: crane record run.mcap --duration 60\n"
      "          crane record run.mcap --split-every 10min --quota 2GB\n"
      "The parts are run_000001.mcap, run_000002.mcap, ...; `crane log info run.mcap` and every other\n"
      "command that reads recordings read them as one. `crane log merge run.mcap joined.mcap` joins them.\n"
      "The file is complete up to the last second, also after a failure\n"
      "(crane log info, crane log repair).");
  command->callback([options, &chosen] { chosen = [options] { return record(*options); }; });
}

}  // namespace crane::cli
