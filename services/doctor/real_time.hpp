#pragma once
/// Checks the computer for a real-time loop: scheduling permission, locked memory, buffers, timer lateness.
#include <chrono>
#include <filesystem>
#include <functional>

#include "doctor/finding.hpp"

namespace crane::doctor {

struct Permissions {
  bool fifo = false;         ///< SCHED_FIFO with the priority of the loop
  bool memory_lock = false;  ///< mlockall
};
[[nodiscard]] Permissions try_permissions(int priority);
[[nodiscard]] Findings judge_permissions(const Permissions& permissions);

struct Buffers {
  std::int64_t largest_bytes = 0;  ///< net.core.rmem_max
  /// Datagrams lost because of a full buffer, and received datagrams, since the start of the network
  /// namespace (outside containers: of the computer).
  std::int64_t lost = 0, received = 0;
};
/// @param proc  "/proc"
[[nodiscard]] Buffers read_buffers(const std::filesystem::path& proc = "/proc");
[[nodiscard]] Findings judge_buffers(const Buffers& buffers);

struct Lateness {
  bool fifo = false;  ///< measured with SCHED_FIFO
  std::size_t ticks = 0;
  double p99_us = 0, max_us = 0;
  std::size_t overruns = 0;  ///< ticks that the bridge would count as overruns
};
/// Measures the lateness of sleeps until absolute times, as the clock master sleeps.
/// @param period_s  control period of the rig
[[nodiscard]] Lateness measure_lateness(double period_s, std::chrono::milliseconds duration, int priority);
/// Largest lateness of a tick that is no overrun: half a period (docs/architecture.md, Clocks).
[[nodiscard]] std::int64_t tolerable_ns(double period_s);
[[nodiscard]] Findings judge_lateness(const Lateness& lateness, double period_s);

}  // namespace crane::doctor
