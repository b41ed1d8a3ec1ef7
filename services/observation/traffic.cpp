#include "observation/traffic.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "crane/runtime/process_name.hpp"

namespace crane::observation {
namespace {

using nlohmann::ordered_json;

/// A larger median delay shows that writer and bridge use the clocks of different hosts.
constexpr double kLongestDelay_us = 60e6;

std::size_t bin_of(double delay_us) {
  return static_cast<std::size_t>(std::ranges::lower_bound(kDelayBounds_us, delay_us) -
                                  kDelayBounds_us.begin());
}

ordered_json json_of(const std::optional<Spread>& spread) {
  if (!spread) return nullptr;
  return {{"p50", spread->p50}, {"p99", spread->p99}, {"max", spread->max}};
}

ordered_json json_of(const topics::Description& topic, const TopicTraffic& traffic) {
  ordered_json line{{"topic", topic.name},
                    {"every_tick", topic.every_tick},
                    {"samples", traffic.counts.samples},
                    {"rate_hz", nullptr},
                    {"writer", source_name(traffic.writer)}};
  if (traffic.window.rate_hz && traffic.window.samples > 0) line["rate_hz"] = *traffic.window.rate_hz;
  line["lost"] = traffic.counts.lost;
  line["late"] = traffic.counts.late;
  line["duplicate"] = traffic.counts.duplicate;
  line["restarts"] = traffic.counts.restarts;
  line["jitter_us"] = json_of(traffic.window.jitter_us);
  line["delay_us"] = json_of(traffic.delay_us);
  line["delay_histogram"] = traffic.delay_histogram;
  return line;
}

ordered_json json_of(const Traffic::NodeReport& report, std::int64_t now_ns) {
  const auto& node = report.status;
  const auto rate_hz = report.tick_rate_hz ? ordered_json(*report.tick_rate_hz) : ordered_json(nullptr);
  return {{"name", node.name},
          {"vendor", node.vendor},
          {"pid", node.pid},
          {"phase", phase_name(node.phase)},
          {"controller", node.controller},
          {"silent", report.silent(now_ns)},
          {"ticks", node.ticks},
          {"tick_rate_hz", rate_hz},
          {"lost", node.lost_ticks},
          {"late", node.late_samples},
          {"duplicate", node.duplicate_samples},
          {"rejected", node.rejected_samples},
          {"foreign", node.foreign_samples},
          {"refused", node.refused_samples},
          {"step_mean_us", node.step_mean_us},
          {"step_max_us", node.step_max_us}};
}

}  // namespace

const char* source_name(crane_Source source) { return runtime::process_name(source); }

const char* phase_name(crane_NodePhase phase) {
  constexpr std::array kNames{"starting", "ready", "stopping"};
  const auto index = static_cast<std::size_t>(phase);
  return index < kNames.size() ? kNames[index] : "unknown";
}

bool Traffic::NodeReport::silent(std::int64_t now_ns) const {
  const bool in_loop = status.node < crane_SOURCE_OPERATOR && status.node != crane_SOURCE_NONE;
  return now_ns - arrival_ns > (in_loop ? kSilent_ns : kSilentWithoutPriority_ns);
}

std::vector<Traffic::Line> Traffic::lines() {
  std::vector<Line> result;
  for (const auto& topic : topics::kAll) result.emplace_back(topic.every_tick);
  return result;
}

void Traffic::add(const Sample& sample) {
  const auto& topic = topic_of(sample);
  auto& line = topics_[sample.topic];
  const auto& header = sample.header;
  line.figures.writer = header.source;
  line.statistics.add({header.tick, header.epoch,
                       topic.every_tick ? header.sample_time_ns : sample.source_time_ns,
                       sample.written_time_ns});
  if (topic.every_tick) {
    constexpr std::size_t kMostDelays = 10'000;  // bounds the memory: one window of a loop at 10 kHz
    const auto delay_us = static_cast<double>(sample.written_time_ns - header.sample_time_ns) * 1e-3;
    if (line.delays_us.size() < kMostDelays) line.delays_us.push_back(delay_us);
    if (delay_us >= 0 && delay_us < kLongestDelay_us) ++line.figures.delay_histogram[bin_of(delay_us)];
  }
  if (msg::NodeStatus status; decode(topics::node, sample, status)) add_status(sample, status);
}

void Traffic::add_status(const Sample& sample, const msg::NodeStatus& status) {
  constexpr std::size_t kMostNodes = 64;
  // A shorter interval is ignored, because a change of phase causes an additional report.
  constexpr std::int64_t kShortest_ns = 500'000'000;
  const auto found = nodes_.find(status.node);
  if (found == nodes_.end() && nodes_.size() >= kMostNodes) return;
  NodeReport report{status, sample.arrival_time_ns, sample.log_time_ns, sample.source_time_ns};
  if (found != nodes_.end()) {
    const auto& before = found->second;
    const auto interval_ns = report.source_time_ns - before.source_time_ns;
    const bool same_start =
        before.status.header.epoch == status.header.epoch && status.ticks >= before.status.ticks;
    if (same_start && interval_ns >= kShortest_ns)
      report.tick_rate_hz =
          static_cast<double>(status.ticks - before.status.ticks) * 1e9 / static_cast<double>(interval_ns);
    else if (same_start)
      report.tick_rate_hz = before.tick_rate_hz;
  }
  nodes_[status.node] = report;
}

bool Traffic::poll(std::int64_t now_ns) {
  if (now_ns < window_ends_ns_) return false;
  window_ends_ns_ = now_ns + kWindow_ns;
  for (auto& line : topics_) {
    line.figures.window = line.statistics.take_window();
    line.figures.counts = line.statistics.counts();
    line.figures.delay_us = spread(line.delays_us);
    if (line.figures.delay_us &&
        (line.figures.delay_us->p50 < 0 || line.figures.delay_us->p50 > kLongestDelay_us))
      line.figures.delay_us.reset();
    line.delays_us.clear();
  }
  return true;
}

ordered_json Traffic::json(std::int64_t now_ns) const {
  ordered_json result{{"delay_bounds_us", kDelayBounds_us},
                      {"topics", ordered_json::array()},
                      {"processes", ordered_json::array()}};
  for (std::size_t i = 0; i < topics_.size(); ++i)
    result["topics"].push_back(json_of(topics::kAll[i], topics_[i].figures));
  for (const auto& [number, report] : nodes_) result["processes"].push_back(json_of(report, now_ns));
  return result;
}

}  // namespace crane::observation
