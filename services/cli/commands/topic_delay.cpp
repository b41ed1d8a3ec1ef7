/// crane topic delay: time from the latching of the encoders to the arrival of a sample.
#include <CLI/CLI.hpp>
#include <cmath>
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

using observation::percentile;
using observation::spread;

struct TopicDelayOptions {
  TopicOptions topic;
  double window_s = 2;
};

void show(const std::vector<double>& delays_us, bool json) {
  const auto found = spread(delays_us);
  if (!found) return;
  if (json)
    std::cout << nlohmann::ordered_json{{"samples", delays_us.size()},
                                        {"p50_us", found->p50},
                                        {"p99_us", found->p99},
                                        {"max_us", found->max}}
                     .dump()
              << std::endl;
  else
    std::cout << "delay us p50 " << fixed(found->p50, 0) << " p99 " << fixed(found->p99, 0) << " max "
              << fixed(found->max, 0) << "  samples " << delays_us.size() << std::endl;
}

/// Warns when the median is negative or longer than kOldest_us: the time stamps are then from another clock.
void warn_of_other_clock(const std::vector<double>& delays_us) {
  constexpr double kOldest_us = 60e6;
  const auto median_us = percentile(delays_us, 0.5);
  if (median_us && (*median_us < 0 || *median_us > kOldest_us))
    std::cerr << "these delays are meaningless: the time stamps are from the clock of another host or from a "
                 "lockstep run\n";
}

int measure(const TopicDelayOptions& options) {
  auto bus = open_bus(options.topic.bus);
  const auto window_ns = static_cast<std::int64_t>(options.window_s * 1e9);
  auto due_ns = runtime::monotonic_ns() + window_ns;
  bool checked = false;
  observation::Joining joining;
  std::vector<double> delays_us;
  const auto end_window = [&] {
    if (!checked) warn_of_other_clock(delays_us);
    checked = checked || !delays_us.empty();
    show(delays_us, options.topic.json);
    delays_us.clear();
  };
  read_topic(
      bus, options.topic,
      [&](const TopicSample& sample) {
        if (!joining.over(sample.header.sample_time_ns, sample.arrival_time_ns)) return;
        delays_us.push_back(static_cast<double>(sample.arrival_time_ns - sample.header.sample_time_ns) *
                            1e-3);
      },
      [&] {
        if (runtime::monotonic_ns() < due_ns) return;
        due_ns += window_ns;
        end_window();
      });
  end_window();
  return runtime::kExitDone;
}

}  // namespace

void add_topic_delay(CLI::App& topic, Action& chosen) {
  auto options = std::make_shared<TopicDelayOptions>();
  auto* command = topic.add_subcommand(
      "delay", "Measure the time from the latching of the encoders to the arrival of the sample");
  add_topic_options(*command, options->topic);
  command->add_option("--window", options->window_s, "interval between two lines in s")
      ->check(positive_number())
      ->capture_default_str();
  command->footer(
      "Example: crane topic delay command --count 1000\n"
      "The command compares the clock of the bridge with the clock of this host: use it on the host of the "
      "bridge.");
  command->callback([options, &chosen] {
    if (!options->topic.topic->every_tick)
      throw CLI::ValidationError("NAME", std::string{options->topic.topic->name} +
                                             " is not written every tick: its samples have no sample time");
    chosen = [options] { return measure(*options); };
  });
}

}  // namespace crane::cli
