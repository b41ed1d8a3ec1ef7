/// crane play: publishes the samples of a recording for the tools that read the bus.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/commands/log.hpp"
#include "cli/number_range.hpp"
#include "cli/player.hpp"
#include "cli/recording_argument.hpp"
#include "cli/sample_json.hpp"
#include "cli/text_table.hpp"
#include "cli/tool_bus.hpp"
#include "commands.hpp"
#include "crane/recording/run_table.hpp"

namespace crane::cli {
namespace {

struct PlayOptions {
  std::filesystem::path file;
  std::vector<const topics::Description*> topics;
  recording::TimeRange range;
  double rate = 1;
  bool loop = false;
  runtime::BusOptions bus = tool_bus();
};

using Topics = std::vector<const topics::Description*>;

/// The topics of --topic; by default all topics with samples in the recording.
Topics played_topics(const PlayOptions& options, const recording::McapReader& recording) {
  std::vector<std::string> problems;
  for (const auto* topic : options.topics)
    if (!may_play(*topic))
      problems.push_back("--topic " + std::string{topic->name} +
                         ": cannot be played, because a crane would execute it");
  const auto difference = recording::version_difference(recording::messages_version(recording));
  if (!difference.empty()) problems.push_back(options.file.string() + ": " + difference);
  if (!options.bus.secure.empty())
    problems.emplace_back(
        "--secure: a recording is not played on a bus with keys: no role may write the topics "
        "of other processes");
  if (!problems.empty()) throw configuration::ConfigurationError(std::move(problems));
  if (!options.topics.empty()) return options.topics;
  Topics all;
  for (const auto& topic : topics::kAll)
    if (may_play(topic)) all.push_back(&topic);
  return all;
}

/// The range of log time that is played, and its first message.
struct Window {
  recording::Selection selection;
  std::int64_t begin_ns = 0;
};

Window window_of(const PlayOptions& options, recording::McapReader& recording, const Topics& topics) {
  Window window{recording::selection_of(recording, options.range), 0};
  for (const auto* topic : topics) window.selection.topics.emplace_back(topic->name);
  auto messages = recording.messages(window.selection);
  const auto* first = messages.next();
  if (first == nullptr)
    throw configuration::ConfigurationError(
        {options.file.string() + ": no sample of the wanted topics in this range"});
  window.begin_ns = first->log_time_ns;
  return window;
}

bus::Options player_bus(const PlayOptions& options) {
  // SOURCE_OPERATOR applies the rule of writing programs on an open network. SOURCE_MONITOR in the samples
  // ensures that no process accepts them.
  auto bus = runtime::bus_options(options.bus, "crane_play", crane_SOURCE_OPERATOR, runtime::random_epoch());
  bus.source = crane_SOURCE_MONITOR;
  return bus;
}

int play(const PlayOptions& options) {
  runtime::install_stop_signals();
  recording::McapReader recording{options.file};
  const auto topics = played_topics(options, recording);
  const auto window = window_of(options, recording, topics);
  const auto bus = player_bus(options);
  Player player{bus, recording, topics};
  std::cerr << "playing " << options.file.string() << " on crane '" << bus.crane << "', domain " << bus.domain
            << "; Ctrl-C ends it\n";
  while (player.play(window.selection, window.begin_ns, options.rate) && options.loop) {
  }
  player.finish();
  const auto& counts = player.counts();
  std::cout << counts.played << " samples played";
  if (counts.failed > 0) std::cout << ", " << counts.failed << " damaged or not sent";
  std::cout << '\n';
  print_log_problems(recording.problems());
  if (!player.other_writer()) return runtime::kExitDone;
  std::cerr << "crane play: another program writes " << *player.other_writer()
            << ": stopped; a recording is played only on a bus without a crane\n";
  return runtime::kExitFailed;
}

int run(const PlayOptions& options) {
  try {
    return play(options);
  } catch (const recording::ReadError& error) {
    std::cerr << "crane: " << error.what() << '\n';
    return runtime::kExitBadInput;
  }
}

}  // namespace

void add_play(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<PlayOptions>();
  auto* command =
      app.add_subcommand("play", "Publish the samples of a recording, for tools on a bus without a crane");
  command->add_option("FILE", options->file, "recording (.mcap)")->required()->check(existing_recording());
  command->add_option("--rate", options->rate, "seconds of the recording per second")
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str();
  command->add_flag("--loop", options->loop, "begin again at the end, until Ctrl-C");
  command
      ->add_option("--from,--seek", options->range.from_s,
                   "first time, in s from the first sample; default: 0")
      ->check(not_negative_number());
  command
      ->add_option("--to", options->range.until_s,
                   "end, in s from the first sample; default: the end of the recording")
      ->check(positive_number());
  command
      ->add_option_function<std::vector<std::string>>(
          "--topic",
          [options](const std::vector<std::string>& names) {
            for (const auto& name : names) options->topics.push_back(&topic_named(name));
          },
          "topic to play (repeatable); default: all except crane/request and crane/jog")
      ->type_name("TOPIC");
  runtime::add_bus_options(*command, options->bus);
  command->footer(
      "Example: crane play run.mcap --rate 0.5 --loop --crane playback\n"
      "         crane dashboard --crane playback\n"
      "The command refuses a bus on which a crane runs, and stops when a crane appears.");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace crane::cli
