#include "recorder/recorder.hpp"

#include <algorithm>
#include <chrono>

#include "crane/bus/cdr.hpp"
#include "crane/runtime/process.hpp"

namespace crane::recorder {
namespace {

std::int64_t wall_ns() {
  return std::chrono::nanoseconds{std::chrono::system_clock::now().time_since_epoch()}.count();
}

bool is_error(const topics::Description& topic, const std::vector<std::uint8_t>& cdr) {
  msg::Event event{};
  const auto body = std::span{cdr}.subspan(bus::kEncapsulation_bytes);
  return bus::CdrCodec::of(*topic.descriptor).decode(body, false, &event) &&
         event.severity == crane_SEVERITY_ERROR;
}

recording::Metadata origin(const bus::Options& options, std::int64_t started_ns) {
  return {{"crane", options.crane},
          {"domain", std::to_string(options.domain)},
          {"recorder_vendor", std::string{bus::to_string(options.vendor)}},
          {"started_ns", std::to_string(started_ns)},
          {"log_time", "arrival, ns since 1970"},
          {"publish_time", "writer's clock, ns since 1970"},
          {"sequence", "tick"}};
}

}  // namespace

Recorder::Recorder(bus::Bus& bus, const Options& options)
    : file_{options.file},
      node_{bus, {"recorder", ""}},
      wall_minus_monotonic_ns_{wall_ns() - runtime::monotonic_ns()} {
  recording::McapWriter writer{options.file};
  const auto channels = recording::add_topic_channels(writer);
  writer.metadata("crane", origin(bus.options(), log_time_ns()));
  for (std::size_t i = 0; i < topics::kAll.size(); ++i) {
    const auto& topic = topics::kAll[i];
    const auto& wanted = options.topics;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), &topic) == wanted.end()) continue;
    bus::EndpointOptions endpoint;
    // the recorder receives earlier events; loop topics have no history
    endpoint.history = topic.qos == topics::Qos::log;
    sources_.push_back(
        {bus.cdr_subscriber(topic, endpoint), channels[i], topic.name == topics::event.description.name});
  }
  thread_ = std::make_unique<RecordingThread>(std::move(writer), options.queue_capacity);
}

bool Recorder::poll() {
  for (auto& source : sources_) take_all(source);
  report();
  if (!thread_->failure()) return true;
  announce_failure();
  return false;
}

bool Recorder::close() {
  thread_->close();
  if (!thread_->failure()) return true;
  announce_failure();
  return false;
}

void Recorder::take_all(Source& source) {
  bus::SampleInfo info;
  std::vector<std::uint8_t> cdr;
  while (const auto header = source.subscriber.take(cdr, &info)) {
    if (!info.valid) continue;
    heard_others_ = heard_others_ || header->source != crane_SOURCE_RECORDER;
    Entry entry;
    entry.channel = source.channel;
    entry.sequence = static_cast<std::uint32_t>(header->tick);
    entry.log_time_ns = log_time_ns();
    entry.publish_time_ns = info.source_time_ns;
    entry.urgent = source.holds_events && is_error(source.subscriber.topic(), cdr);
    entry.data = std::move(cdr);
    thread_->put(std::move(entry));
  }
}

void Recorder::report() {
  runtime::JoinCounts counts;
  counts.completed = thread_->written();
  counts.lost = thread_->dropped();
  node_.beat(runtime::monotonic_ns(), crane_PHASE_READY, counts, rejected());
}

void Recorder::announce_failure() {
  if (failure_announced_) return;
  failure_announced_ = true;
  node_.error("recording_failed", "recording stopped: " + thread_->failure().value_or(""),
              "free space or use another disk, and start a new recording; this one is readable up to here "
              "(crane log repair)");
}

std::uint64_t Recorder::rejected() const {
  std::uint64_t sum = 0;
  for (const auto& source : sources_) sum += source.subscriber.counts().rejected;
  return sum;
}

std::int64_t Recorder::log_time_ns() const { return runtime::monotonic_ns() + wall_minus_monotonic_ns_; }

}  // namespace crane::recorder
