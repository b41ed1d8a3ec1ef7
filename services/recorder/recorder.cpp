#include "recorder/recorder.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

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

/// Content of each file before its first sample.
RecordingFiles::Prepare prepare(const recording::Metadata& crane, const std::string& rig_text,
                                std::int64_t started_ns) {
  return [=](recording::McapWriter& writer) {
    recording::add_topic_channels(writer);
    writer.metadata("crane", crane);
    if (!rig_text.empty())
      writer.attachment("rig.toml", "application/toml", started_ns,
                        {reinterpret_cast<const std::uint8_t*>(rig_text.data()), rig_text.size()});
    std::vector<std::string> topics;
    for (const auto& topic : topics::kAll) topics.emplace_back(topic.name);
    return topics;
  };
}

/// Counts the samples that DDS reports as lost.
bus::EventHandler counter_of_lost(const std::shared_ptr<std::atomic<std::uint64_t>>& lost) {
  return [lost](const bus::Event& event) {
    if (event.kind == bus::EventKind::sample_lost && event.current >= 0)
      *lost = static_cast<std::uint64_t>(event.current);
  };
}

}  // namespace

Recorder::Recorder(bus::Bus& bus, const Options& options)
    : file_{options.file},
      node_{bus, {"recorder", ""}},
      wall_minus_monotonic_ns_{wall_ns() - runtime::monotonic_ns()} {
  const auto started_ns = log_time_ns();
  RecordingFiles files{options.file, options.limits,
                       prepare(origin(bus.options(), started_ns), options.rig_text, started_ns)};
  for (std::size_t i = 0; i < topics::kAll.size(); ++i) {
    const auto& topic = topics::kAll[i];
    const auto& wanted = options.topics;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), &topic) == wanted.end()) continue;
    bus::EndpointOptions endpoint;
    // The recorder receives events from before its start; loop topics have no history.
    endpoint.history = topic.qos == topics::Qos::log;
    const auto lost = std::make_shared<std::atomic<std::uint64_t>>(0);
    endpoint.on_event = counter_of_lost(lost);
    sources_.push_back({.subscriber = bus.cdr_subscriber(topic, endpoint),
                        .channel = static_cast<std::uint16_t>(i),
                        .holds_events = topic.name == topics::event.description.name,
                        .lost = lost,
                        .missing = MissingSamples{topic.every_tick}});
  }
  thread_ = std::make_unique<RecordingThread>(std::move(files), options.queue_capacity);
}

bool Recorder::poll() {
  for (auto& source : sources_) {
    take_all(source);
    note_losses(source, false);
  }
  report();
  announce_warnings();
  if (!thread_->failure()) return true;
  announce_failure();
  return false;
}

bool Recorder::close() {
  for (auto& source : sources_) note_losses(source, true);
  thread_->close();
  announce_warnings();
  if (!thread_->failure()) return true;
  announce_failure();
  return false;
}

void Recorder::take_all(Source& source) {
  bus::SampleInfo info;
  std::vector<std::uint8_t> cdr;
  while (const auto header = source.subscriber.take(cdr, &info)) {
    if (!info.valid) continue;
    if (!source.heard) {
      // A vendor may report samples that were published before the reader joined as lost.
      source.heard = true;
      source.lost_seen = *source.lost;
    }
    count_gap(source, *header);
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

void Recorder::note_losses(Source& source, bool all) {
  const auto now_ns = log_time_ns();
  const auto pass = [&](recording::LossCause cause, std::uint64_t& seen, std::uint64_t total) {
    if (total > seen) source.missing.report(cause, total - seen, now_ns);
    seen = std::max(seen, total);
  };
  if (source.heard) pass(recording::LossCause::dds_lost, source.lost_seen, *source.lost);
  pass(recording::LossCause::wrong_crc, source.rejected_seen, source.subscriber.counts().rejected);
  for (const auto& found : source.missing.take(now_ns, all))
    thread_->lose(source.channel, found.cause, found.samples, found.time_ns);
}

void Recorder::count_gap(Source& source, const msg::Header& header) {
  const auto last = std::exchange(source.last, header);
  if (!source.subscriber.topic().every_tick) return;
  if (last.epoch != header.epoch || last.source != header.source)
    source.missing.begin_writer();
  else if (header.tick > last.tick)
    source.missing.gap(header.tick - last.tick - 1, log_time_ns());
}

void Recorder::announce_warnings() {
  for (const auto& warning : thread_->take_warnings())
    node_.error("recording_incomplete", warning,
                "do not move, delete or protect the files of a recording that is being written");
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
