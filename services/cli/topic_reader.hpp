#pragma once
/// Reads one topic of any type; shared by `crane topic echo`, `hz` and `delay`.
#include <functional>
#include <vector>

#include "cli/tool_bus.hpp"

namespace crane::cli {

struct TopicOptions {
  const topics::Description* topic = nullptr;
  double duration_s = 1e9;
  std::uint64_t count = 0;  ///< number of samples; 0: unlimited
  bool json = false;
  runtime::BusOptions bus = tool_bus();
};
/// Adds NAME, --duration, --count, --json and the bus options.
void add_topic_options(CLI::App& command, TopicOptions& options);

/// One sample; valid during the call only.
struct TopicSample {
  const msg::Header& header;
  const bus::SampleInfo& info;
  std::int64_t arrival_time_ns;  ///< monotonic
  const std::vector<std::uint8_t>& cdr;
};

/// Calls `visit` for each sample, and `wake` at least every 20 ms. Without samples it prints possible reasons
/// once on standard error. @return number of samples rejected for a wrong CRC
/// @throws std::runtime_error, with the reason, when no sample arrived until the end
std::uint64_t read_topic(
    bus::Bus& bus, const TopicOptions& options, const std::function<void(const TopicSample&)>& visit,
    const std::function<void()>& wake = [] {});

}  // namespace crane::cli
