#pragma once
/// Reads one topic of any type until there is a reason to stop: what `crane topic echo`, `hz` and `delay`
/// share.
#include <functional>
#include <vector>

#include "cli/tool_bus.hpp"

namespace crane::cli {

struct TopicOptions {
  const topics::Description* topic = nullptr;
  double duration_s = 1e9;
  std::uint64_t count = 0;  ///< samples, 0: no end
  bool json = false;
  runtime::BusOptions bus = tool_bus();
};
/// NAME, --duration, --count, --json and the bus options.
void add_topic_options(CLI::App& command, TopicOptions& options);

/// One sample; valid inside the call.
struct TopicSample {
  const msg::Header& header;
  const bus::SampleInfo& info;
  std::int64_t arrival_time_ns;  ///< monotonic
  const std::vector<std::uint8_t>& cdr;
};

/// Calls `visit` for each sample, and `wake` at least every 20 ms. Says on standard error, once, why nothing
/// may be coming. @return samples rejected for a wrong CRC
/// @throws std::runtime_error when nothing came until the end, with the reason
std::uint64_t read_topic(
    bus::Bus& bus, const TopicOptions& options, const std::function<void(const TopicSample&)>& visit,
    const std::function<void()>& wake = [] {});

}  // namespace crane::cli
