#pragma once
/// Ends a process that spins with real-time scheduling.
#include <chrono>

namespace crane::runtime {

/// Longest computation of a real-time thread without a blocking call. A tick takes less than 1 ms, a
/// time-optimal plan less than 100 ms.
inline constexpr std::chrono::milliseconds kLongestSpin{500};

/// From now on the kernel sends SIGXCPU to this process when one of its threads with SCHED_FIFO has used the
/// processor for kLongestSpin without a blocking call, and SIGKILL when it continues for as long again. Such
/// a thread starves all processes of lower priority, including the supervisor and the operator's shell. When
/// the process has ended, its silence stops the crane. Has no effect on threads with ordinary scheduling.
/// @throws std::system_error
void limit_spin_time();

}  // namespace crane::runtime
