/// crane topic ls: all topics with their writers and rates.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/number_range.hpp"
#include "cli/text_table.hpp"
#include "cli/tool_bus.hpp"
#include "observation/arrival_statistics.hpp"
#include "topic.hpp"

namespace crane::cli {
namespace {

using observation::ArrivalStatistics;

struct TopicLsOptions {
  double window_s = 2;
  bool json = false;
  runtime::BusOptions bus = tool_bus();
};

struct Line {
  bus::CdrSubscriber subscriber;
  ArrivalStatistics statistics;
  ArrivalStatistics::Window window{};
};

std::vector<Line> observe(bus::Bus& bus, double window_s) {
  std::vector<Line> lines;
  for (const auto& topic : topics::kAll)
    lines.push_back({bus.cdr_subscriber(topic), ArrivalStatistics{topic.every_tick}});
  std::vector<std::uint8_t> cdr;
  bus::SampleInfo info;
  wait_until(bus, window_s, [&] {
    for (auto& line : lines)
      while (const auto header = line.subscriber.take(cdr, &info))
        if (info.valid)
          line.statistics.add(
              {header->tick, header->epoch,
               line.subscriber.topic().every_tick ? header->sample_time_ns : info.source_time_ns,
               runtime::monotonic_ns()});
    return false;
  });
  for (auto& line : lines) {
    line.window = line.statistics.take_window();
    // Other topics may have several writers, and samples from before the start of this process: no rate.
    if (!line.subscriber.topic().every_tick) line.window.rate_hz.reset();
  }
  return lines;
}

void print_table(const std::vector<Line>& lines) {
  TextTable table{{"topic", "type", "writers", "samples", "rate Hz"}};
  for (const auto& line : lines) {
    const auto& rate = line.window.rate_hz;
    table.add({std::string{line.subscriber.topic().name}, std::string{line.subscriber.topic().type},
               std::to_string(line.subscriber.matched()), std::to_string(line.window.samples),
               rate ? fixed(*rate, 2) : "-"});
  }
  table.print(std::cout);
}

void print_json(const std::vector<Line>& lines) {
  auto result = nlohmann::ordered_json::array();
  for (const auto& line : lines) {
    nlohmann::ordered_json entry{{"topic", line.subscriber.topic().name},
                                 {"type", line.subscriber.topic().type},
                                 {"writers", line.subscriber.matched()},
                                 {"samples", line.window.samples},
                                 {"rate_hz", nullptr}};
    if (line.window.rate_hz) entry["rate_hz"] = *line.window.rate_hz;
    result.push_back(entry);
  }
  std::cout << result.dump(2) << '\n';
}

int list(const TopicLsOptions& options) {
  auto bus = open_bus(options.bus);
  const auto lines = observe(bus, options.window_s);
  options.json ? print_json(lines) : print_table(lines);
  for (const auto& line : lines)
    if (line.subscriber.matched() > 0) return runtime::kExitDone;
  throw std::runtime_error("no topic has a writer" + where_and_remedy(bus));
}

}  // namespace

void add_topic_ls(CLI::App& topic, Action& chosen) {
  auto options = std::make_shared<TopicLsOptions>();
  auto* command = topic.add_subcommand("ls", "List all topics with type, writers, samples and rate");
  command->add_option("--window", options->window_s, "duration of the measurement in s")
      ->check(positive_number())
      ->capture_default_str();
  command->add_flag("--json", options->json, "print one JSON array");
  runtime::add_bus_options(*command, options->bus);
  command->footer("Example: crane topic ls --window 5");
  command->callback([options, &chosen] { chosen = [options] { return list(*options); }; });
}

}  // namespace crane::cli
