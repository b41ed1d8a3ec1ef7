/// crane topic: observes the topics of a running crane.
#include "topic.hpp"

#include <CLI/CLI.hpp>

namespace crane::cli {

void add_topic(CLI::App& app, Action& chosen) {
  auto* topic = app.add_subcommand("topic", "List topics, print samples, measure rates and delays");
  topic->footer("Example: crane topic ls\ndocs/wiring.md lists the topics, their writers and readers.");
  add_topic_ls(*topic, chosen);
  add_topic_echo(*topic, chosen);
  add_topic_hz(*topic, chosen);
  add_topic_delay(*topic, chosen);
}

}  // namespace crane::cli
