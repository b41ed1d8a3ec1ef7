#include "crane/runtime/turn.hpp"

#include <algorithm>
#include <chrono>

#include "crane/bus/path_stamps.hpp"

namespace crane::runtime {

void Turn::begin(Component& component, std::int64_t period_ns) {
  period_ns_ = period_ns;
  component_ = &component;
  run();
}

void Turn::end() {
  component_ = nullptr;
  while (const unsigned running = requests_) requests_.wait(running);
}

void Turn::run() {
  if (requests_.fetch_add(1) > 0) return;
  unsigned served = 1;
  do poll();
  while (!requests_.compare_exchange_strong(served, 0));
  requests_.notify_all();
}

void Turn::poll() {
  Component* const component = component_;
  if (component == nullptr) return;
  std::int64_t wake_at_ns = kNever;
  std::exception_ptr failure;
  try {
    for (bool again = true; again;) {
      const auto now_ns = monotonic_ns_();
      if (auto* const stamps = bus::path_stamps()) stamps->polled(now_ns);
      again = component->poll(now_ns);
    }
    wake_at_ns = component->wake_at_ns();
  } catch (...) {  // an exception must not enter the vendor's code
    failure = std::current_exception();
    component_ = nullptr;
  }
  const std::lock_guard lock{mutex_};
  wake_at_ns_ = wake_at_ns;
  if (wake_at_ns != kNever) due_ns_ = wake_at_ns;
  if (failure) failure_ = failure;
  if (failure || wake_at_ns_ < sleeps_until_ns_) changed_.notify_one();
}

void Turn::wake() {
  const std::lock_guard lock{mutex_};
  woken_ = true;
  changed_.notify_one();
}

void Turn::wait(std::int64_t longest_ns) {
  std::unique_lock lock{mutex_};
  const auto now_ns = monotonic_ns_();
  sleeps_until_ns_ = std::min(wake_at_ns_, now_ns + longest_ns);
  // After the first input of a tick, the component requests the time at which its wait for the other inputs
  // ends. If the main thread slept longer, each tick would wake it only to shorten its sleep. Therefore it
  // wakes a tenth of a period before the expected time: one period after the last one.
  const auto expected_ns = due_ns_ + period_ns_ - period_ns_ / 10;
  if (wake_at_ns_ == kNever && expected_ns > now_ns)
    sleeps_until_ns_ = std::min(sleeps_until_ns_, expected_ns);
  while (!failure_ && !woken_ && monotonic_ns_() < sleeps_until_ns_) {
    changed_.wait_for(lock, std::chrono::nanoseconds{sleeps_until_ns_ - monotonic_ns_()});
    sleeps_until_ns_ = std::min(sleeps_until_ns_, wake_at_ns_);
  }
  sleeps_until_ns_ = 0;
  woken_ = false;
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace crane::runtime
