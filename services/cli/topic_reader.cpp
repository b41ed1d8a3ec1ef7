#include "cli/topic_reader.hpp"
#include "cli/number_range.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <mutex>

#include "cli/sample_json.hpp"

namespace crane::cli {
namespace {

/// Name of the QoS policy that did not match. A DDS thread sets it; the main thread reads it.
class RefusedPolicy {
 public:
  void set(std::string_view policy) {
    const std::lock_guard lock{mutex_};
    policy_ = policy;
  }
  [[nodiscard]] std::string get() const {
    const std::lock_guard lock{mutex_};
    return policy_;
  }

 private:
  mutable std::mutex mutex_;
  std::string policy_;
};

std::string why_silent(bus::Bus& bus, const bus::CdrSubscriber& subscriber, const RefusedPolicy& refused) {
  const std::string name{subscriber.topic().name};
  if (const auto others = bus.other_versions(); !others.empty())
    return name + ": " + bus::refusal(others.front());
  if (const auto rejected = subscriber.counts().rejected; rejected > 0)
    return name + ": all " + std::to_string(rejected) + " samples had a wrong CRC; check the network";
  if (const auto policy = refused.get(); !policy.empty())
    return name + ": a writer exists, but its quality of service does not match (" + policy +
           "); check --clock, and that both programs have the same version";
  if (subscriber.matched() == 0) return name + ": no writer found" + where_and_remedy(bus);
  return name + ": " + std::to_string(subscriber.matched()) + " writers, but no sample: " +
         (subscriber.topic().every_tick ? "the clock master starts no ticks (crane status)"
                                        : "the topic is written only at events");
}

/// Prints the possible reason once when no sample arrives.
class Hint {
 public:
  void give(const std::function<std::string()>& reason) {
    constexpr std::int64_t kAfter_ns = 3'000'000'000;
    if (given_ || runtime::monotonic_ns() - begin_ns_ < kAfter_ns) return;
    given_ = true;
    std::cerr << "waiting: " << reason() << '\n';
  }

 private:
  std::int64_t begin_ns_ = runtime::monotonic_ns();
  bool given_ = false;
};

}  // namespace

void add_topic_options(CLI::App& command, TopicOptions& options) {
  command
      .add_option_function<std::string>(
          "NAME", [&options](const std::string& name) { options.topic = &topic_named(name); },
          "crane/state, or state")
      ->required()
      ->type_name("TOPIC");
  command.add_option("--duration", options.duration_s, "duration in s")->check(positive_number());
  command.add_option("--count", options.count, "number of samples")->check(positive_number());
  command.add_flag("--json", options.json, "print one JSON object per line");
  runtime::add_bus_options(command, options.bus);
}

std::uint64_t read_topic(bus::Bus& bus, const TopicOptions& options,
                         const std::function<void(const TopicSample&)>& visit,
                         const std::function<void()>& wake) {
  const auto refused = std::make_shared<RefusedPolicy>();
  bus::EndpointOptions endpoint;
  endpoint.history = options.topic->qos == topics::Qos::log;
  endpoint.on_event = [refused](const bus::Event& event) {
    if (event.kind == bus::EventKind::incompatible_qos) refused->set(event.policy);
  };
  auto subscriber = bus.cdr_subscriber(*options.topic, endpoint);
  std::vector<std::uint8_t> cdr;
  bus::SampleInfo info;
  std::uint64_t received = 0;
  Hint hint;
  const auto finished = [&] { return options.count > 0 && received >= options.count; };
  wait_until(bus, options.duration_s, [&] {
    while (!finished()) {
      const auto header = subscriber.take(cdr, &info);
      if (!header) break;
      if (!info.valid) continue;
      ++received;
      visit({*header, info, runtime::monotonic_ns(), cdr});
    }
    wake();
    if (received == 0) hint.give([&] { return why_silent(bus, subscriber, *refused); });
    return finished();
  });
  if (received == 0) throw std::runtime_error(why_silent(bus, subscriber, *refused));
  return subscriber.counts().rejected;
}

}  // namespace crane::cli
