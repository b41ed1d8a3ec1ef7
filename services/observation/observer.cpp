#include "observation/observer.hpp"

#include <chrono>
#include <thread>

#include "crane/runtime/process.hpp"

namespace crane::observation {
namespace {

using std::chrono::milliseconds;

/// Time to gather the samples of one tick, which arrive within 1 ms to 2 ms. Taking them together costs a
/// fifth of the processor time of one wake-up per sample.
constexpr milliseconds kGather{4};

}  // namespace

Observer::Observer(bus::Bus& bus, Deliver deliver) : bus_{bus}, deliver_{std::move(deliver)} {
  for (const auto& topic : topics::kAll) {
    bus::EndpointOptions endpoint;
    endpoint.history = topic.qos == topics::Qos::log;
    readers_.push_back(bus.cdr_subscriber(topic, endpoint));
  }
}

void Observer::poll() {
  constexpr milliseconds kLongestWait{20};
  if (bus_.wait(kLongestWait)) std::this_thread::sleep_for(kGather);
  std::vector<SamplePtr> samples;
  bus::SampleInfo info;
  std::vector<std::uint8_t> cdr;
  const auto monotonic_minus_wall_ns =
      runtime::monotonic_ns() -
      std::chrono::nanoseconds{std::chrono::system_clock::now().time_since_epoch()}.count();
  for (std::size_t i = 0; i < readers_.size(); ++i)
    while (const auto header = readers_[i].take(cdr, &info)) {
      if (!info.valid) continue;
      samples.push_back(std::make_shared<const Sample>(
          Sample{.topic = i,
                 .header = *header,
                 .source_time_ns = info.source_time_ns,
                 .arrival_time_ns = runtime::monotonic_ns(),
                 .written_time_ns = info.source_time_ns + monotonic_minus_wall_ns,
                 .log_time_ns = log_now_ns(),
                 .cdr = cdr}));
    }
  if (!samples.empty()) deliver_(std::move(samples));
}

std::int64_t log_now_ns() {
  static const auto kWallMinusMonotonic_ns =
      std::chrono::nanoseconds{std::chrono::system_clock::now().time_since_epoch()}.count() -
      runtime::monotonic_ns();
  return runtime::monotonic_ns() + kWallMinusMonotonic_ns;
}

}  // namespace crane::observation
