#pragma once
/// A timer on every processor that runs beside a real-time test and detects pauses of the computer itself.
/// When the host of a virtual machine takes a processor away, a real-time test can fail although the code has
/// no defect.
#include <atomic>
#include <cstdint>
#include <latch>
#include <string>
#include <thread>
#include <vector>

namespace crane::real_time_test {

/// A wake-up this late counts as a pause: 5 ms is half a period of 10 ms, the lateness that makes a tick an
/// overrun.
inline constexpr std::int64_t kPause_ns = 5'000'000;

class TimerWitness {
 public:
  /// Starts one thread per processor: Each thread is pinned and, if the system permits it, has a priority
  /// above all priorities of a stack. Returns when all threads watch.
  TimerWitness();
  ~TimerWitness();
  TimerWitness(const TimerWitness&) = delete;
  TimerWitness& operator=(const TimerWitness&) = delete;

  /// Pauses since the last call: wake-ups that were late by kPause_ns or more.
  struct Report {
    int pauses = 0;              ///< number of pauses
    std::uint64_t ticks = 0;     ///< upper bound of the ticks of 10 ms that one process loses
    std::int64_t latest_ns = 0;  ///< largest lateness of any wake-up
  };
  [[nodiscard]] Report take();
  /// False when the system denied real-time priority: then a busy processor looks like a pause.
  [[nodiscard]] bool has_priority() const { return has_priority_; }

 private:
  void watch(unsigned processor);

  std::latch watching_;
  std::atomic<bool> stop_{false}, has_priority_{true};
  std::atomic<int> pauses_{0};
  std::atomic<std::uint64_t> ticks_{0};
  std::atomic<std::int64_t> latest_ns_{0};
  std::vector<std::thread> threads_;
};

}  // namespace crane::real_time_test
