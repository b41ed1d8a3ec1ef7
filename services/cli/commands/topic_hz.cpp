/// crane topic hz: rate, losses and jitter of one topic.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/number_range.hpp"
#include "cli/text_table.hpp"
#include "cli/topic_reader.hpp"
#include "observation/arrival_statistics.hpp"
#include "topic.hpp"

namespace crane::cli {
namespace {

using observation::ArrivalStatistics;

struct TopicHzOptions {
  TopicOptions topic;
  double window_s = 2;
};

void print_line(const ArrivalStatistics::Window& window, const ArrivalStatistics::Counts& counts,
                bool counts_ticks) {
  std::cout << (window.rate_hz ? fixed(*window.rate_hz, 2) + " Hz" : "no rate yet") << "  samples "
            << counts.samples;
  if (counts_ticks)
    std::cout << "  lost " << counts.lost << "  late " << counts.late << "  duplicate " << counts.duplicate;
  if (counts.restarts > 0) std::cout << "  restarts " << counts.restarts;
  if (const auto& jitter = window.jitter_us)
    std::cout << "  arrival jitter us p50 " << fixed(jitter->p50, 0) << " p99 " << fixed(jitter->p99, 0)
              << " max " << fixed(jitter->max, 0);
  std::cout << std::endl;
}

void print_json(const ArrivalStatistics::Window& window, const ArrivalStatistics::Counts& counts,
                bool counts_ticks) {
  nlohmann::ordered_json line{{"rate_hz", nullptr}, {"samples", counts.samples}};
  if (window.rate_hz) line["rate_hz"] = *window.rate_hz;
  if (counts_ticks) {
    line["lost"] = counts.lost;
    line["late"] = counts.late;
    line["duplicate"] = counts.duplicate;
  }
  line["restarts"] = counts.restarts;
  line["jitter_us"] = nullptr;
  if (const auto& jitter = window.jitter_us)
    line["jitter_us"] = {{"p50", jitter->p50}, {"p99", jitter->p99}, {"max", jitter->max}};
  std::cout << line.dump() << std::endl;
}

int measure(const TopicHzOptions& options) {
  auto bus = open_bus(options.topic.bus);
  const bool counts_ticks = options.topic.topic->every_tick;
  ArrivalStatistics statistics{counts_ticks};
  const auto window_ns = static_cast<std::int64_t>(options.window_s * 1e9);
  auto due_ns = runtime::monotonic_ns() + window_ns;
  std::uint64_t shown = 0;
  const auto show = [&] {
    const auto window = statistics.take_window();
    shown = statistics.counts().samples;
    options.topic.json ? print_json(window, statistics.counts(), counts_ticks)
                       : print_line(window, statistics.counts(), counts_ticks);
  };
  read_topic(
      bus, options.topic,
      [&](const TopicSample& sample) {
        const auto source_time_ns = counts_ticks ? sample.header.sample_time_ns : sample.info.source_time_ns;
        statistics.add({sample.header.tick, sample.header.epoch, source_time_ns, sample.arrival_time_ns});
      },
      [&] {
        if (runtime::monotonic_ns() < due_ns) return;
        due_ns += window_ns;
        if (statistics.counts().samples > 0) show();
      });
  if (statistics.counts().samples > shown) show();
  return runtime::kExitDone;
}

}  // namespace

void add_topic_hz(CLI::App& topic, Action& chosen) {
  auto options = std::make_shared<TopicHzOptions>();
  auto* command = topic.add_subcommand("hz", "Measure rate, lost samples and arrival jitter of a topic");
  add_topic_options(*command, options->topic);
  command->add_option("--window", options->window_s, "interval between two lines in s")
      ->check(positive_number())
      ->capture_default_str();
  command->footer(
      "Example: crane topic hz command --duration 10\n"
      "Rate and jitter refer to the window; counts begin at the start of the command. Jitter is the\n"
      "difference between the interval of two arrivals and their interval at the source. Losses are\n"
      "known only for topics written every tick; the rate of all other topics is computed from the time\n"
      "stamps of the writer.");
  command->callback([options, &chosen] { chosen = [options] { return measure(*options); }; });
}

}  // namespace crane::cli
