/// crane topic echo: prints the samples of one topic of any type.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>

#include "cli/sample_json.hpp"
#include "cli/topic_reader.hpp"
#include "topic.hpp"

namespace crane::cli {
namespace {

struct TopicEchoOptions {
  TopicOptions topic;
  std::string field;
};

void print_block(const std::vector<recording::Leaf>& leaves) {
  std::size_t width = 0;
  for (const auto& leaf : leaves) width = std::max(width, leaf.first.size());
  for (const auto& [name, value] : leaves)
    std::cout << name << ": " << std::string(width - name.size(), ' ') << text_of(value) << '\n';
  if (leaves.size() > 1) std::cout << "---\n";
}

void print_line(const nlohmann::ordered_json& sample, const std::vector<recording::Leaf>& leaves,
                bool whole) {
  if (whole) {
    std::cout << sample.dump() << '\n';
    return;
  }
  nlohmann::ordered_json selected;
  for (const auto& [name, value] : leaves) selected[name] = value;
  std::cout << selected.dump() << '\n';
}

int echo(const TopicEchoOptions& options) {
  auto bus = open_bus(options.topic.bus);
  const auto rejected = read_topic(bus, options.topic, [&](const TopicSample& received) {
    const auto sample = schema().decode(options.topic.topic->type, received.cdr);
    const auto leaves = leaves_below(sample, options.field);
    options.topic.json ? print_line(sample, leaves, options.field.empty()) : print_block(leaves);
    std::cout << std::flush;
  });
  if (rejected > 0) std::cerr << rejected << " samples had a wrong CRC and were dropped\n";
  return runtime::kExitDone;
}

/// Checks the field name before the first sample, because a wrong name would print nothing.
void check_field(const TopicEchoOptions& options) {
  if (options.field.empty()) return;
  std::string known;
  for (const auto& name : schema().columns(options.topic.topic->type)) {
    if (is_below(name, options.field)) return;
    known += (known.empty() ? "" : ", ") + name;
  }
  throw CLI::ValidationError("--field", "no field '" + options.field + "' in " +
                                            std::string{options.topic.topic->type} + ", only " + known);
}

}  // namespace

void add_topic_echo(CLI::App& topic, Action& chosen) {
  auto options = std::make_shared<TopicEchoOptions>();
  auto* command = topic.add_subcommand("echo", "Print samples as they arrive");
  add_topic_options(*command, options->topic);
  command->add_option("--field", options->field,
                      "only this field and its parts: header.tick, applied_v[0], axis[1]");
  command->footer("Example: crane topic echo state --field trolley_position_m --count 10");
  command->callback([options, &chosen] {
    check_field(*options);
    chosen = [options] { return echo(*options); };
  });
}

}  // namespace crane::cli
