#pragma once
/// Counts how often a shared computer did not let a thread run that wakes every 10 ms and does nothing: ticks
/// that a process loses in those moments are not the stack's.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

namespace crane::system_test {

class PauseWitness {
 public:
  /// Wakes later than 2 ms so far.
  [[nodiscard]] std::uint64_t pauses() const { return pauses_; }

 private:
  void watch(const std::stop_token& stop) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds kTick{10}, kLate{2};
    for (auto due = Clock::now() + kTick; !stop.stop_requested(); due += kTick) {
      std::this_thread::sleep_until(due);
      if (Clock::now() - due > kLate) ++pauses_;
    }
  }

  std::atomic<std::uint64_t> pauses_{0};
  std::jthread thread_{[this](const std::stop_token& stop) { watch(stop); }};
};

}  // namespace crane::system_test
