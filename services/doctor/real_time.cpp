#include "doctor/real_time.hpp"

#include <sched.h>
#include <sys/mman.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <thread>

#include "crane/runtime/process.hpp"
#include "observation/arrival_statistics.hpp"

namespace crane::doctor {
namespace {

/// Receive buffer that Cyclone DDS requests from the kernel (Internal/SocketReceiveBufferSize, default 1
/// MiB).
constexpr std::int64_t kWantedBuffer_bytes = 1 << 20;

/// Runs `work` in a separate thread, so that its scheduling ends with the thread. @return true when the
/// thread had SCHED_FIFO
template <class Work>
bool with_fifo(int priority, Work work) {
  bool granted = false;
  std::thread{[&] {
    const sched_param parameters{.sched_priority = priority};
    granted = priority > 0 && ::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
    work();
  }}.join();
  return granted;
}

/// Parses pairs of lines "Udp: names" and "Udp: numbers".
std::int64_t udp_count(const std::filesystem::path& proc, const std::string& name) {
  std::ifstream file{proc / "net/snmp"};
  std::string names, numbers;
  while (std::getline(file, names) && std::getline(file, numbers)) {
    if (!names.starts_with("Udp: ")) continue;
    std::istringstream all{names}, values{numbers};
    std::string key, value;
    while (all >> key && values >> value)
      if (key == name) return std::stoll(value);
  }
  return 0;
}

}  // namespace

Permissions try_permissions(int priority) {
  Permissions permissions;
  permissions.fifo = with_fifo(priority, [] {});
  permissions.memory_lock = ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  ::munlockall();
  return permissions;
}

Findings judge_permissions(const Permissions& permissions) {
  Findings findings;
  if (!permissions.fifo)
    findings.push_back(
        {Grade::problem, "rt", "no_realtime_scheduling",
         "this user may not use SCHED_FIFO: ticks are late under load",
         "put `@crane - rtprio 98` in /etc/security/limits.d/crane.conf and the user in the group "
         "crane, or start the service crane.service"});
  if (!permissions.memory_lock)
    findings.push_back({Grade::advice, "rt", "memory_not_locked",
                        "this user may not lock memory: a page fault can delay a tick",
                        "put `@crane - memlock unlimited` in /etc/security/limits.d/crane.conf"});
  if (findings.empty())
    findings.push_back({Grade::good, "rt", "permissions", "SCHED_FIFO and locked memory are permitted", ""});
  return findings;
}

Buffers read_buffers(const std::filesystem::path& proc) {
  Buffers buffers;
  std::ifstream{proc / "sys/net/core/rmem_max"} >> buffers.largest_bytes;
  buffers.lost = udp_count(proc, "RcvbufErrors");
  buffers.received = udp_count(proc, "InDatagrams");
  return buffers;
}

Findings judge_buffers(const Buffers& buffers) {
  Findings findings;
  if (buffers.largest_bytes > 0 && buffers.largest_bytes < kWantedBuffer_bytes)
    findings.push_back({Grade::advice, "rt", "small_receive_buffer",
                        "receive buffers are limited to " + std::to_string(buffers.largest_bytes / 1024) +
                            " kB, the bus asks for " + std::to_string(kWantedBuffer_bytes / 1024) + " kB",
                        "`sysctl -w net.core.rmem_max=" + std::to_string(kWantedBuffer_bytes) + "`"});
  if (buffers.lost > 0)
    findings.push_back({Grade::advice, "rt", "datagrams_lost",
                        std::to_string(buffers.lost) + " datagrams found a full receive buffer (" +
                            std::to_string(buffers.received) +
                            " were received) since the start of the computer or container",
                        "check with `crane topic hz crane/state` whether the crane loses samples; raise "
                        "net.core.rmem_max, or end other programs of this computer"});
  if (findings.empty())
    findings.push_back(
        {Grade::good, "rt", "receive_buffers",
         "receive buffers of " + std::to_string(buffers.largest_bytes / 1024) + " kB, no datagram lost", ""});
  return findings;
}

std::int64_t tolerable_ns(double period_s) { return static_cast<std::int64_t>(period_s * 1e9 / 2); }

Lateness measure_lateness(double period_s, std::chrono::milliseconds duration, int priority) {
  Lateness lateness;
  std::vector<double> late_us;
  lateness.fifo = with_fifo(priority, [&] {
    const auto period_ns = static_cast<std::int64_t>(period_s * 1e9);
    const auto end_ns = runtime::monotonic_ns() + std::chrono::nanoseconds{duration}.count();
    for (auto next_ns = runtime::monotonic_ns() + period_ns;
         next_ns < end_ns && !runtime::stop_requested();) {
      const timespec at{.tv_sec = next_ns / 1'000'000'000, .tv_nsec = next_ns % 1'000'000'000};
      ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
      const auto late_ns = runtime::monotonic_ns() - next_ns;
      late_us.push_back(static_cast<double>(late_ns) * 1e-3);
      if (late_ns > tolerable_ns(period_s)) ++lateness.overruns;
      next_ns += period_ns * (1 + late_ns / period_ns);  // missed ticks are skipped, as by the bridge
    }
  });
  lateness.ticks = late_us.size();
  if (const auto spread = observation::spread(late_us)) {
    lateness.p99_us = spread->p99;
    lateness.max_us = spread->max;
  }
  return lateness;
}

Findings judge_lateness(const Lateness& lateness, double period_s) {
  const auto tolerable_us = static_cast<double>(tolerable_ns(period_s)) * 1e-3;
  const std::string what = "the timer wakes " + std::to_string(std::llround(lateness.p99_us)) +
                           " us late (99 %), at most " + std::to_string(std::llround(lateness.max_us)) +
                           " us in " + std::to_string(lateness.ticks) + " ticks of " +
                           std::to_string(std::llround(period_s * 1e3)) + " ms" +
                           (lateness.fifo ? ", with SCHED_FIFO" : ", with ordinary scheduling") +
                           "; the loop tolerates " + std::to_string(std::llround(tolerable_us)) + " us";
  if (lateness.overruns > 0)
    return {{Grade::problem, "rt", "timer_late", what,
             (lateness.fifo
                  ? "look for programs with a higher priority (`ps -eLo rtprio,comm --sort -rtprio`), for a "
                    "virtual machine and for power saving of the processor"
                  : "permit SCHED_FIFO, and take load from this computer")}};
  // Share of the tolerated lateness, because several processes of the loop can be late in one tick.
  constexpr double kMargin = 0.2;
  if (lateness.max_us > kMargin * tolerable_us)
    return {{Grade::advice, "rt", "timer_nearly_late", what,
             "take load from this computer while the crane runs"}};
  return {{Grade::good, "rt", "timer", what, ""}};
}

}  // namespace crane::doctor
