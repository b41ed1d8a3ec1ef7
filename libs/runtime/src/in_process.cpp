#include "crane/runtime/in_process.hpp"

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

void InProcessStack::add(const ComponentSpec& spec, const configuration::Rig& rig,
                         const control::Controller& controller) {
  Room room;
  room.bus = std::make_unique<bus::Bus>(memory_options(network_, std::string{spec.program}, spec.source));
  room.hosted = std::make_unique<HostedComponent>(*room.bus, spec, rig, controller, Clock::lockstep);
  rooms_.push_back(std::move(room));
}

bool InProcessStack::pump() {
  const auto now_ns = monotonic_ns();
  bool anything = false;
  // The first pass polls all components, the next passes only those with new samples. When such a pass
  // processes nothing, one more pass polls all components, because a component may store samples of later
  // ticks or requests that are due.
  for (bool all = true, progress = true; all || progress; all = !all && !progress) {
    progress = false;
    for (auto& room : rooms_) {
      const bool has_samples = room.bus->wait(std::chrono::nanoseconds{0});
      if (all || has_samples) progress = room.hosted->component().poll(now_ns) || progress;
    }
    anything = anything || progress;
  }
  return anything;
}

std::string InProcessStack::waiting_for() const {
  std::string lines;
  for (const auto& room : rooms_)
    lines +=
        std::string{room.hosted->component().name()} + ": " + room.hosted->component().waiting_for() + '\n';
  return lines;
}

}  // namespace crane::runtime
