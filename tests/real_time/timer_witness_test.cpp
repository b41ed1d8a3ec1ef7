#include "timer_witness.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <chrono>

namespace crane::real_time_test {
namespace {

using namespace std::chrono_literals;

/// Occupies processor 0 completely, like the host of a virtual machine.
bool occupy_processor(std::chrono::milliseconds duration) {
  bool granted = false;
  std::thread{[&] {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(0, &set);
    const sched_param parameters{.sched_priority = 99};
    granted = ::pthread_setaffinity_np(::pthread_self(), sizeof set, &set) == 0 &&
              ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters) == 0;
    const auto end = std::chrono::steady_clock::now() + duration;
    while (granted && std::chrono::steady_clock::now() < end) {
    }
  }}.join();
  return granted;
}

TEST(TimerWitness, DetectsAnOccupiedProcessor) {
  TimerWitness witness;
  (void)witness.take();
  if (!occupy_processor(20ms)) GTEST_SKIP() << "real-time priority was denied";
  TimerWitness::Report report;
  while ((report = witness.take()).pauses == 0) std::this_thread::yield();  // the time limit ends this loop
  EXPECT_GE(report.ticks, 2U) << "a tick that begins late, and at least one that is missed";
}

TEST(TimerWitness, CountsAPauseOnce) {
  TimerWitness witness;
  if (!occupy_processor(20ms)) GTEST_SKIP() << "real-time priority was denied";
  while (witness.take().pauses == 0) std::this_thread::yield();
  EXPECT_EQ(witness.take().latest_ns / 15'000'000, 0) << "the pause was reported before";
}

}  // namespace
}  // namespace crane::real_time_test
