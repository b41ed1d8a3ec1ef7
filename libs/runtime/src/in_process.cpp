#include "crane/runtime/in_process.hpp"

#include <algorithm>
#include <chrono>

#include "crane/runtime/process.hpp"

namespace crane::runtime {
namespace {
constexpr std::uint32_t kEpoch = 1;  // the same number as the processes of `crane run` in lockstep
}

bus::Options memory_options(std::shared_ptr<bus::MemoryNetwork> network, std::string participant,
                            crane_Source source) {
  bus::Options options;
  options.vendor = bus::Vendor::memory;
  options.participant = std::move(participant);
  options.source = source;
  options.epoch = kEpoch;
  options.network = std::move(network);
  return options;
}

InProcessStack::InProcessStack(std::span<const ComponentSpec> specs, const configuration::Rig& rig,
                               const control::Controller& controller)
    : network_{bus::make_memory_network()} {
  for (const auto& spec : specs) add(spec, rig, controller);
}

InProcessStack::InProcessStack(std::span<const ComponentSpec> specs, const configuration::Rig& rig,
                               const control::Controller& controller, const BusOf& bus_of) {
  for (const auto& spec : specs) add(spec, rig, controller, bus_of(spec), Clock::realtime);
}

void InProcessStack::add(const ComponentSpec& spec, const configuration::Rig& rig,
                         const control::Controller& controller) {
  add(spec, rig, controller, bus::Bus{memory_options(network_, std::string{spec.program}, spec.source)},
      Clock::lockstep);
}

void InProcessStack::add(const ComponentSpec& spec, const configuration::Rig& rig,
                         const control::Controller& controller, bus::Bus bus, Clock clock) {
  Entry& entry = entries_.emplace_back(std::move(bus));
  if (!network_) entry.bus.call_on_arrival([this, &entry](std::string_view /*topic*/) { arrived(entry); });
  entry.hosted = std::make_unique<HostedComponent>(entry.bus, spec, rig, controller, clock,
                                                   clock == Clock::realtime ? monotonic_ns : nullptr);
}

/// Runs in the thread that delivers the sample: a thread of the vendor, or the thread of pump().
void InProcessStack::arrived(Entry& entry) {
  entry.has_samples = true;
  {
    const std::lock_guard lock{mutex_};
    arrived_ = true;
  }
  arrival_.notify_one();
}

bool InProcessStack::pump() {
  const auto begin_ns = monotonic_ns();
  bool anything = false;
  // The first pass polls all components, the next passes only those with new samples. When a pass processes
  // nothing, another pass polls all components, which may store samples of later ticks or due requests.
  for (bool all = true, progress = true; all || progress; all = !all && !progress) {
    progress = false;
    {
      const std::lock_guard lock{mutex_};
      arrived_ = false;
    }
    for (auto& entry : entries_) {
      const bool has_samples =
          network_ ? entry.bus.wait(std::chrono::nanoseconds{0}) : entry.has_samples.exchange(false);
      if (!all && !has_samples) continue;
      const auto now_ns = network_ ? begin_ns : monotonic_ns();
      progress = entry.hosted->component().poll(now_ns) || progress;
    }
    anything = anything || progress;
  }
  return anything;
}

void InProcessStack::wait(std::int64_t latest_ns) {
  for (const auto& entry : entries_) latest_ns = std::min(latest_ns, entry.hosted->component().wake_at_ns());
  std::unique_lock lock{mutex_};
  arrival_.wait_until(lock, std::chrono::steady_clock::time_point{std::chrono::nanoseconds{latest_ns}},
                      [this] { return arrived_; });
}

std::string InProcessStack::waiting_for() const {
  std::string lines;
  for (const auto& entry : entries_)
    lines +=
        std::string{entry.hosted->component().name()} + ": " + entry.hosted->component().waiting_for() + '\n';
  return lines;
}

}  // namespace crane::runtime
