/// crane supervisor explain: the rule table, and the requests that the present state refuses.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/commands/log.hpp"
#include "cli/number_range.hpp"
#include "cli/snapshot.hpp"
#include "cli/tool_bus.hpp"
#include "commands.hpp"
#include "crane/bus/cdr.hpp"
#include "crane/recording/mcap_reader.hpp"
#include "crane/supervisor/explain.hpp"
#include "crane/supervisor/rules.hpp"

namespace crane::cli {
namespace {

struct ExplainOptions {
  std::string state;
  bool live = false;
  double timeout_s = 3;
  runtime::BusOptions bus = tool_bus();
};

template <class T>
void keep_last(const topics::Topic<T>& topic, const recording::Message& message, std::optional<T>& last) {
  if (message.channel->topic != topic.description.name || message.data.size() < bus::kEncapsulation_bytes)
    return;
  T sample{};
  if (bus::CdrCodec::of(*topic.description.descriptor)
          .decode(message.data.subspan(bus::kEncapsulation_bytes), false, &sample))
    last = sample;
}

Snapshot last_of(const std::string& file) {
  recording::McapReader reader{file};
  Snapshot snapshot;
  reader.for_each({.topics = {std::string{topics::state.description.name},
                              std::string{topics::supervisor.description.name}}},
                  [&](const recording::Message& message) {
                    keep_last(topics::state, message, snapshot.state);
                    keep_last(topics::supervisor, message, snapshot.supervisor);
                    return true;
                  });
  if (!snapshot.supervisor) throw std::runtime_error(file + ": contains no crane/supervisor");
  print_log_problems(reader.problems());
  if (!reader.problems().empty()) std::cerr << "the recording is damaged: a later state may be missing\n";
  std::cout << "tick " << snapshot.supervisor->header.tick << '\n';
  return snapshot;
}

void explain_present(const Snapshot& snapshot) {
  const auto& status = *snapshot.supervisor;
  const auto cause = static_cast<supervisor::Cause>(status.cause);
  std::cout << supervisor::name_of(static_cast<supervisor::State>(status.state));
  if (cause != supervisor::Cause::none)
    std::cout << " because of " << supervisor::name_of(cause) << ": " << supervisor::remedy_for(cause);
  std::cout << '\n';
  for (const auto& line : supervisor::explain(status, snapshot.state ? &*snapshot.state : nullptr))
    std::cout << line.request << ": " << (line.accepted ? "accepted" : "refused: " + line.reason) << '\n';
}

int explain(const ExplainOptions& options) {
  if (!options.state.empty()) {
    explain_present(last_of(options.state));
  } else if (options.live) {
    auto bus = open_bus(options.bus);
    const auto snapshot = safety_state(bus, options.timeout_s);
    if (!snapshot.supervisor)
      throw std::runtime_error("no sample of the supervisor received" + where_and_remedy(bus));
    explain_present(snapshot);
  } else {
    std::cout << supervisor::rule_table();
  }
  return runtime::kExitDone;
}

}  // namespace

void add_supervisor(CLI::App& app, Action& chosen) {
  auto* group = app.add_subcommand("supervisor", "Explain the decisions of the supervisor");
  group->footer("Example: crane supervisor explain --live\ndocs/safety.md describes the rules.");
  group->require_subcommand(1);
  auto* command = group->add_subcommand(
      "explain",
      "Print the rule table; with --live or --state: whether the state accepts reset, arm, move and home");
  auto options = std::make_shared<ExplainOptions>();
  auto* recorded = command->add_option("--state", options->state, "explain the last state of this recording");
  command->add_flag("--live", options->live, "explain the state of the running crane")->excludes(recorded);
  command->add_option("--timeout", options->timeout_s, "longest wait for the supervisor in s")
      ->check(number_in(kShortestWait_s, kLongestWait_s));
  runtime::add_bus_options(*command, options->bus);
  command->callback([options, &chosen] { chosen = [options] { return explain(*options); }; });
}

}  // namespace crane::cli
