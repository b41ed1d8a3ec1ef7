#include "campaign/virtual_stack.hpp"

#include <algorithm>
#include <stdexcept>

#include "crane/runtime/in_process.hpp"

namespace crane::campaign {
namespace {
constexpr std::uint32_t kFirstEpoch = 1;
constexpr std::int64_t kShortestStep_ns =
    100'000;  // a component that has asked for the past is asked again then
}  // namespace

VirtualStack::VirtualStack(std::span<const runtime::ComponentSpec> specs, const configuration::Rig& rig,
                           const control::Controller& controller)
    : rig_{rig}, controller_{controller}, network_{bus::make_memory_network()} {
  for (const auto& spec : specs) {
    rooms_.push_back({.spec = spec, .bus = nullptr, .hosted = nullptr});
    fill(rooms_.back(), kFirstEpoch);
  }
}

void VirtualStack::fill(Room& room, std::uint32_t epoch) {
  auto options = runtime::memory_options(network_, std::string{room.spec.program}, room.spec.source);
  options.epoch = epoch;
  room.bus = std::make_unique<bus::Bus>(options);
  room.hosted = std::make_unique<runtime::HostedComponent>(*room.bus, room.spec, rig_, controller_,
                                                           runtime::Clock::realtime);
}

VirtualStack::Room& VirtualStack::room_of(crane_Source source) {
  const auto found =
      std::ranges::find_if(rooms_, [&](const Room& room) { return room.spec.source == source; });
  if (found == rooms_.end()) throw std::logic_error{"no such component in this stack"};
  return *found;
}

void VirtualStack::suspend(crane_Source source, std::int64_t time_ns) {
  room_of(source).suspended_until_ns = time_ns;
}

void VirtualStack::kill(crane_Source source) {
  Room& room = room_of(source);
  room.hosted.reset();
  room.bus.reset();
}

void VirtualStack::restart(crane_Source source, std::uint32_t epoch) {
  Room& room = room_of(source);
  kill(source);
  fill(room, epoch);
}

void VirtualStack::settle() {
  for (bool progress = true; progress;) {
    progress = false;
    for (auto& room : rooms_)
      while (room.hosted && room.suspended_until_ns <= now_ns_ && polled(room)) progress = true;
  }
}

/// An exception ends a process, and with it the component.
bool VirtualStack::polled(Room& room) {
  try {
    return room.hosted->component().poll(now_ns_);
  } catch (const std::runtime_error&) {
    kill(room.spec.source);
    return true;
  }
}

std::int64_t VirtualStack::next_wake_ns() const {
  std::int64_t next_ns = runtime::kNever;
  for (const auto& room : rooms_)
    if (room.hosted)
      next_ns = std::min(next_ns, std::max(room.hosted->component().wake_at_ns(), room.suspended_until_ns));
  return next_ns;
}

void VirtualStack::run_until(std::int64_t time_ns) {
  settle();
  for (auto next_ns = next_wake_ns(); next_ns <= time_ns; next_ns = next_wake_ns()) {
    now_ns_ = std::min(std::max(next_ns, now_ns_ + kShortestStep_ns), time_ns);
    settle();
    if (now_ns_ == time_ns) break;
  }
  now_ns_ = std::max(now_ns_, time_ns);
}

}  // namespace crane::campaign
