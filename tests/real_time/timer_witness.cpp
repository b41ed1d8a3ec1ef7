#include "timer_witness.hpp"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <ctime>

namespace crane::real_time_test {
namespace {

constexpr std::int64_t kStep_ns = 1'000'000, kTick_ns = 10'000'000;
constexpr int kPriority = 90;  // above the 50 to 60 of a stack

std::int64_t now_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

bool pin_and_raise(unsigned processor) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(processor, &set);
  const sched_param parameters{.sched_priority = kPriority};
  return ::pthread_setaffinity_np(::pthread_self(), sizeof set, &set) == 0 &&
         ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters) == 0;
}

unsigned processors() { return std::max(1U, std::thread::hardware_concurrency()); }

}  // namespace

TimerWitness::TimerWitness() : watching_{static_cast<std::ptrdiff_t>(processors())} {
  for (unsigned i = 0; i < processors(); ++i) threads_.emplace_back([this, i] { watch(i); });
  watching_.wait();
}

TimerWitness::~TimerWitness() {
  stop_ = true;
  for (auto& thread : threads_) thread.join();
}

TimerWitness::Report TimerWitness::take() {
  return {pauses_.exchange(0), ticks_.exchange(0), latest_ns_.exchange(0)};
}

void TimerWitness::watch(unsigned processor) {
  if (!pin_and_raise(processor)) has_priority_ = false;
  auto next_ns = now_ns() + kStep_ns;
  watching_.count_down();
  while (!stop_) {
    const timespec at{.tv_sec = next_ns / 1'000'000'000, .tv_nsec = next_ns % 1'000'000'000};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
    const auto late_ns = now_ns() - next_ns;
    if (late_ns >= kPause_ns) {
      ++pauses_;
      ticks_ += static_cast<std::uint64_t>(1 + late_ns / kTick_ns);
    }
    auto latest_ns = latest_ns_.load();
    while (late_ns > latest_ns && !latest_ns_.compare_exchange_weak(latest_ns, late_ns)) {
    }
    next_ns += late_ns > kStep_ns ? late_ns - late_ns % kStep_ns + kStep_ns : kStep_ns;
  }
}

}  // namespace crane::real_time_test
