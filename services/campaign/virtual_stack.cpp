#include "campaign/virtual_stack.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "crane/runtime/in_process.hpp"

namespace crane::campaign {
namespace {
constexpr std::uint32_t kFirstEpoch = 1;
// Delay before the next poll of a component whose requested time is in the past.
constexpr std::int64_t kShortestStep_ns = 100'000;
}  // namespace

VirtualStack::VirtualStack(std::span<const runtime::ComponentSpec> specs, const configuration::Rig& rig,
                           const control::Controller& controller, std::shared_ptr<bus::Ledger> ledger)
    : rig_{rig}, controller_{controller}, ledger_{std::move(ledger)}, network_{bus::make_memory_network()} {
  for (const auto& spec : specs) {
    slots_.push_back({.spec = spec, .bus = nullptr, .hosted = nullptr});
    start_in(slots_.back(), kFirstEpoch);
  }
}

void VirtualStack::start_in(Slot& slot, std::uint32_t epoch) {
  auto options = runtime::memory_options(network_, std::string{slot.spec.program}, slot.spec.source);
  options.epoch = epoch;
  options.ledger = ledger_;
  slot.bus = std::make_unique<bus::Bus>(options);
  slot.hosted = std::make_unique<runtime::HostedComponent>(*slot.bus, slot.spec, rig_, controller_,
                                                           runtime::Clock::realtime);
}

VirtualStack::Slot& VirtualStack::slot_of(crane_Source source) {
  const auto found =
      std::ranges::find_if(slots_, [&](const Slot& slot) { return slot.spec.source == source; });
  if (found == slots_.end()) throw std::logic_error{"no such component in this stack"};
  return *found;
}

void VirtualStack::suspend(crane_Source source, std::int64_t time_ns) {
  slot_of(source).suspended_until_ns = time_ns;
}

void VirtualStack::kill(crane_Source source) {
  Slot& slot = slot_of(source);
  slot.hosted.reset();
  slot.bus.reset();
}

void VirtualStack::restart(crane_Source source, std::uint32_t epoch) {
  Slot& slot = slot_of(source);
  kill(source);
  start_in(slot, epoch);
}

void VirtualStack::settle() {
  for (bool progress = true; progress;) {
    progress = false;
    for (auto& slot : slots_)
      while (slot.hosted && slot.suspended_until_ns <= now_ns_ && polled(slot)) progress = true;
  }
}

/// An exception ends the component, as it would end its process.
bool VirtualStack::polled(Slot& slot) {
  try {
    return slot.hosted->component().poll(now_ns_);
  } catch (const std::runtime_error&) {
    kill(slot.spec.source);
    return true;
  }
}

std::int64_t VirtualStack::next_wake_ns() const {
  std::int64_t next_ns = runtime::kNever;
  for (const auto& slot : slots_)
    if (slot.hosted)
      next_ns = std::min(next_ns, std::max(slot.hosted->component().wake_at_ns(), slot.suspended_until_ns));
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
